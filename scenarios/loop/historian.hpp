#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "scenarios/loop/closed_loop.hpp"
#include "scenarios/study/record_options.hpp"
#include "scenarios/study/study.hpp"

// How a historian of the plant stores the measured CVs, and how its reader restores them. Methods of
// assessment see a loop in this form; the controller and the truth use the measurements themselves.

namespace mpm {

/// The loop of experiment `index` as its record shows it. y is changed by these steps, one after the other,
/// each only if `study.record` asks for it:
///
/// 0. rows: with `sampling` and `shift`, the exact rows of record_rows.hpp (Trajectory::y_sampled) take the
///    place of the samples. MVs and MDs are held, and only shifted.
/// 1. outliers: a sample of a CV is an outlier with the probability outlier_share; outlier_size is added, up
///    or down.
/// 2. quantisation: the nearest multiple of the step.
/// 3. bad values: in spells, which each CV has of its own, the value is the last good one or one far off. If
///    the record has their quality, its reader leaves bad values out: they become gaps.
/// 4. gaps: a Markov chain of two states (Gilbert 1960), whose gaps have missing_length samples in the mean
///    and take missing_share of the record; each CV has its own. A gap is NaN.
/// 5. exception reporting, reported(), and compression by the swinging door, compressed(), from gap to gap.
/// 6. filling: gaps are filled by GapFill, at the ends of the record with the nearest value. A CV without any
///    sample stays NaN.
///
/// A pure function of its arguments, with streams of its own; the basis case has kBasisIndex. MVs and
/// measured disturbances are numbers that the controller computes or receives: nothing else happens to them.
Trajectory recorded(const Study& study, std::int64_t index, Trajectory loop);

/// The values that a reader gets for `signal` from a historian with a swinging door (Bristol 1990). The
/// historian archives the last point before the straight line from the previous archived point would miss a
/// sample in between by more than `deviation`; the reader reads samples in between on the line. So no sample
/// is off by more than `deviation`, and the first and the last one are exact. Bristol, E.H. (1990), "Swinging
/// door trending: adaptive trend recording?", ISA National Conference Proceedings, 749-754.
Eigen::RowVectorXd compressed(const Eigen::Ref<const Eigen::RowVectorXd>& signal, double deviation);

/// The values that a reader gets for `signal` with exception reporting: a value is reported if it differs
/// from the last reported one by more than `deviation`, and it stays until the next report.
Eigen::RowVectorXd reported(const Eigen::Ref<const Eigen::RowVectorXd>& signal, double deviation);

/// The signal with its gaps (NaN) filled.
Eigen::RowVectorXd filled(Eigen::RowVectorXd signal, GapFill fill);

}  // namespace mpm
