#pragma once

#include <array>
#include <cstdint>

namespace mpm {

/// The named random streams of one experiment. The numbers are part of what makes a study repeatable: a new
/// stream gets the next free number, and no number is ever used again.
enum class StreamId : std::uint32_t {
  mismatch = 0,            ///< which model is wrong, and by how much
  disturbance_draw = 1,    ///< gain and time constant of the unmeasured disturbance
  disturbance_signal = 2,  ///< the white sequence that drives the unmeasured disturbance
  measurement_noise = 3,   ///< noise on the measured outputs
  excitation = 4,          ///< steps of the measured disturbances and setpoints
  kind = 5,                ///< the kind of the experiment: mismatch, disturbance or both
  bootstrap = 6,           ///< resampling in the aggregates
  audit = 7,               ///< which steps of the controller are solved again as a check
  identification = 8,      ///< moves of the references in the records that T0 is identified from
  tuning = 9,              ///< which weight of the controller is changed, and by how much
  mismatch_extent = 10,    ///< further channels or parameters that a mismatch changes
  disturbance_shape = 11,  ///< signal and place of the unmeasured disturbance, and its further CVs
  other_fault = 12,        ///< which instrument, valve, limit or MV is at fault, and by how much
  md_measurement = 13,     ///< noise on the measurement of an MD
  onset = 14,              ///< when the faults begin
  impact = 15,             ///< intended size of the effect of the faults
  suite_cell = 40,         ///< the seed of a cell of a suite
  noise_factor = 20,       ///< size of the measurement noise of an experiment
  outliers = 21,           ///< which samples of the record are outliers, and their sizes
  missing = 22,            ///< which samples of the record are missing
  md_noise = 23,           ///< variation of the measured disturbances
  dither = 24,             ///< test signals that are added to MVs
  bad_values = 25,         ///< which values of the record are bad
  candidate = 50,          ///< which logged candidate drives a disturbance, if one does
  candidate_signals = 51,  ///< the first logged candidate; the numbers up to 59 belong to the others
  blind_order = 70,        ///< order of the loops of a blind export
  world = 80,              ///< the model errors of a world, and the size and colour of its background
  listed_steps = 82,       ///< times, order and sizes of the listed steps of one loop
  background = 81,         ///< the background disturbances of one loop
  valve_start = 83,        ///< initial position of a sticking valve
  background_swell = 84,   ///< how the size of the background varies: range of a world, phase of a loop
  world_valves = 85,       ///< the characteristics of the valves of a world
  /// The signal of the second disturbance of a named scenario; the third takes the next number, and so on.
  further_disturbance_signals = 0x1000,
};

/// One block of Philox4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3",
/// SC 2011): a bijection of 128-bit counters chosen by a 64-bit key.
std::array<std::uint32_t, 4> philox4x32_10(const std::array<std::uint32_t, 4>& counter,
                                           const std::array<std::uint32_t, 2>& key);

/// A sequence of random numbers which is a pure function of (master seed, experiment, stream, position).
///
/// | word      | holds |
/// |-----------|-------|
/// | key 0, 1  | master seed, low and high half |
/// | counter 0 | block; a block has two 64-bit values |
/// | counter 1 | stream in the low 16 bits, repetition in the high 16 bits (see `below`) |
/// | counter 2, 3 | experiment index, low and high half |
///
/// Every drawing function takes exactly one 64-bit value and moves the position on by one. A draw that is
/// replaced by one of another kind therefore leaves all later draws as they were, and two studies that differ
/// in one distribution stay comparable experiment by experiment (common random numbers).
///
/// A stream has 2^33 values; it is cheap to make and to copy, and belongs to one thread.
class RandomStream {
 public:
  /// The stream `stream` of experiment `experiment` under the master seed `seed`, at position 0.
  RandomStream(std::uint64_t seed, std::uint64_t experiment, StreamId stream);

  /// 64 random bits.
  std::uint64_t bits();

  /// Uniform on [0, 1): the multiples of 2^-53, each with the same probability.
  double uniform();

  /// Uniform on [low, high). `high` itself may appear through rounding of low + (high - low) u.
  /// @throws InputError unless low <= high and high - low is finite
  double uniform(double low, double high);

  /// Uniform on {0, ..., n - 1}, without any bias.
  ///
  /// The upper half of the product n * bits is the result (Lemire 2019). The few values that would make it
  /// uneven are drawn again from the same position under the next repetition number, so that the draws after
  /// this one do not move.
  /// @throws InputError when n is 0
  std::uint64_t below(std::uint64_t n);

  /// Standard normal, by inversion of the distribution function at the midpoints (k + 1/2) 2^-53.
  ///
  /// Inversion rather than Box-Muller, because it maps one value to one variate: no half of a pair is kept
  /// between calls, the variate grows with the underlying uniform value, and the central part needs
  /// arithmetic alone, no sine or cosine of the C library. The largest magnitude is about 8.29.
  double normal();

  /// Number of values drawn so far.
  std::uint64_t position() const { return position_; }

 private:
  std::uint64_t value_at(std::uint64_t position, std::uint32_t repetition);

  std::array<std::uint32_t, 2> key_;
  std::uint32_t stream_;
  std::array<std::uint32_t, 2> experiment_;
  std::uint64_t position_ = 0;
  std::array<std::uint32_t, 4> block_{};  // the block of the position last drawn, repetition 0
};

}  // namespace mpm
