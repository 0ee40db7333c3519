#pragma once

#include <vector>

#include "bench/perf/qp_sequence.hpp"

namespace mpm {

/// Registers the benchmarks of the quadratic programs,
///     qp/<problem>/<slack>/<loop>/<samples>/<back end>/<warm or cold>
/// over the whole recorded loop ("all") with the back ends that are fast enough for it, and over 20 samples
/// after its first disturbance step ("20") with every back end. `sequences` must outlive the benchmarks.
///
/// Counters: the members of QpTimes.
void register_qp_benchmarks(const std::vector<QpSequence>& sequences);

/// Registers the benchmarks of what a study is made of,
///     loop/<loop>/<back end>     one closed loop
///     loop/setpoint/active-set   one closed loop of chapter4-shell: setpoint MPC, 900 samples
///     sensitivity/<back end>     T0 (appendix A3)
///     diagnosis                  the chain of one loop, nominal outputs included
///     study/<experiments>        basis case and the first experiments, one process, back end active-set
/// `study` must outlive the benchmarks. Throws InputError when `experiments` is no number of experiments.
void register_study_benchmarks(const Study& study, std::int64_t experiments);

/// The samples that every back end solves: a few, for the slow ones, from the first disturbance step on.
inline constexpr std::size_t kPairedFirst = 20, kPairedCount = 20;

}  // namespace mpm
