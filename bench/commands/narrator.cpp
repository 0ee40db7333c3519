#include "bench/commands/narrator.hpp"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/study_files/resolved_study.hpp"
#include "base/sha256.hpp"
#include "bench/commands/dry_run.hpp"
#include "bench/files/outside_files.hpp"

namespace mpm {

void Narrator::say(const std::string& text) const {
  if (verbose_)
    progress_.note(text);
}

void Narrator::end_stage(const std::string& stage) {
  const Clock::time_point now = Clock::now();
  say(fmt::format("{}: {:.2f} s", stage,
                  std::chrono::duration<double>(now - std::exchange(start_, now)).count()));
}

void Narrator::say_what_is_run(const std::string& found_as, const Study& study, const RunOptions& options,
                               const std::string& output) const {
  if (!verbose_)
    return;
  const Study of_run = study_to_run(study, options);
  say(fmt::format("study: {} ({}), {} bytes, SHA-256 {}...", study.name, found_as, study.source.size(),
                  digest_of(study.source)));
  if (const std::string outside = outside_files(study); !outside.empty())
    say(fmt::format("from outside: {}", outside));
  for (const std::string& change : changed_defaults(of_run))
    say(fmt::format("not the default: {}", change));
  say(fmt::format("seed: {}; methods: {}", of_run.seed, fmt::join(of_run.methods, ", ")));
  say(solver_text(of_run, options));
  say(fmt::format("writes: {}", output));
}

CampaignHooks Narrator::with_stages(CampaignHooks hooks) {
  hooks.on_basis = [this, inner = hooks.on_basis](const Study& study, const BasisCase& basis) {
    end_stage("basis case");
    if (inner)
      inner(study, basis);
  };
  hooks.on_end = [this, inner = hooks.on_end](Campaign& campaign) {
    end_stage("loops");
    if (inner)
      inner(campaign);
    end_stage("findings and archive");
  };
  return hooks;
}

}  // namespace mpm
