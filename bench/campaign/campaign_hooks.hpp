#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bench/execution/stop_request.hpp"
#include "results/archive/campaign.hpp"

namespace mpm {

/// Hooks that watch and stop a run; each may be empty.
struct CampaignHooks {
  /// Asked at each step of the basis case, and before each experiment.
  StopRequest stop = {};
  /// Called once, when the basis case has been run and before it is checked.
  std::function<void(const Study&, const BasisCase&)> on_basis = {};
  /// Called once before the first experiment: an earlier run has left `done` of the `count` experiments.
  std::function<void(std::int64_t done, std::int64_t count)> on_start = {};
  /// Called after each finished experiment, in the order of completion; `failed`: the experiment failed.
  std::function<void(bool failed)> on_done = {};
  /// Called with a text that the user must see.
  std::function<void(const std::string&)> on_warning = {};
  /// Called with the whole campaign while its shards are still locked: the place to write its archive.
  std::function<void(Campaign&)> on_end = {};
};

}  // namespace mpm
