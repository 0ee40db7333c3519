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

/// Registers the benchmarks of closed loops,
///     loop/<loop>/<back end>      a recorded loop of `study`
///     loop/setpoint/<back end>    chapter4-shell, scenario 1: setpoint MPC
///     basis/<study>/auto          the basis loop of every shipped study
///     tank/nonlinear, tank/linear the basis loop of chapter5-tank, integrated, and on its linear model
///
/// | counter          | meaning                                                              |
/// |------------------|----------------------------------------------------------------------|
/// | samples          | of the loop                                                          |
/// | kkt              | largest KKT residual                                                 |
/// | fallbacks        | problems of the loop that the active-set method left to Ipopt        |
/// | plant_share      | share of the loop's processor time in Plant::advance (tank only)     |
/// | controller_share | the rest of it: the steps of the controller and the noise added      |
void register_loop_benchmarks(const Study& study);

/// Registers the benchmarks of the other parts of a study,
///     sensitivity/<back end>     T0 (appendix A3)
///     diagnosis                  the chain of one loop, nominal outputs included
///     study/<experiments>        basis case and the first experiments, one process, back end active-set
/// `study` must outlive the benchmarks. Throws InputError if the study does not have so many experiments.
void register_study_benchmarks(const Study& study, std::int64_t experiments);

/// Registers the loops of made-up plants (SparseLoop) of all sizes,
///     size/<CVs>x<MVs>/<slack>     200 samples, back end active-set
///
/// | counter                   | meaning                                                       |
/// |---------------------------|---------------------------------------------------------------|
/// | median_us, p99_us, max_us | a step of the controller, over the samples of the last pass   |
/// | targets_share             | share of the steps' time in the solver of the targets         |
/// | moves_share               | share of the steps' time in the solver of the moves           |
/// | iterations                | of the moves, mean                                            |
/// | kkt                       | largest KKT residual                                          |
/// | not_solved, programs      | samples without a move; samples                               |
/// | making_ms                 | time to make the controller, before the first step            |
void register_size_benchmarks();

/// The samples that every back end solves, from the first disturbance step on: few, because some are slow.
inline constexpr std::size_t kPairedFirst = 20, kPairedCount = 20;

}  // namespace mpm
