#pragma once

#include <vector>

#include <Eigen/Core>

namespace mpm {

/// The timing of an analyser, such as a gas chromatograph: it takes a sample of the stream every `period`
/// samples of the controller, shows the result `delay` samples later, and its output is held until the next
/// analysis. With period 1 and delay 0 a CV is measured at every sample.
struct AnalyserTiming {
  int period = 1;  ///< samples, >= 1
  int delay = 0;   ///< samples, >= 0
  int first = 0;   ///< sample at which the first sample of the stream is taken, 0 to period - 1

  bool is_analyser() const { return period > 1 || delay > 0; }
  /// Returns the sample at which the value that is shown at sample k was taken: the largest first + i period
  /// <= k - delay; -1 before the first analysis is there.
  Eigen::Index taken(Eigen::Index k) const;

  bool operator==(const AnalyserTiming&) const = default;
};

/// Is one of the variables measured by an analyser?
bool has_analysers(const std::vector<AnalyserTiming>& timings);

/// The analysers of all CVs or MDs, one sample after the other. At sample k they show y(taken(k)).
class AnalyserHold {
 public:
  /// One timing for each variable; empty: all variables are measured at every sample.
  explicit AnalyserHold(const std::vector<AnalyserTiming>& timings);

  /// Starts at sample 0 and shows `y` (ny) until the first analyses are there.
  void reset(const Eigen::Ref<const Eigen::VectorXd>& y);
  /// Replaces `y` (ny), the values at the next sample, by the values that are shown. Allocates nothing.
  void pass(Eigen::Ref<Eigen::VectorXd> y);

 private:
  struct Channel {
    Eigen::Index variable;
    AnalyserTiming timing;
    Eigen::VectorXd past;  ///< the last delay + 1 values, a ring
    double shown;
  };
  std::vector<Channel> channels_;
  Eigen::Index sample_ = 0;
};

/// Returns the analyses behind the values that an analyser has shown, `shown` (N), each at the sample at
/// which it was taken. All other samples are NaN, as are analyses that the record ends too early to show.
Eigen::RowVectorXd analyses(const AnalyserTiming& timing, const Eigen::Ref<const Eigen::RowVectorXd>& shown);

/// Returns the timing with the `first` that makes most changes of `shown` (N, NaN where missing) new
/// analyses.
AnalyserTiming with_first_of(AnalyserTiming timing, const Eigen::Ref<const Eigen::RowVectorXd>& shown);

/// Returns `signals` (n x N) as their analysers show them, and `rest` (n) until the first analyses are there.
Eigen::MatrixXd as_shown(const std::vector<AnalyserTiming>& timings, Eigen::MatrixXd signals,
                         const Eigen::Ref<const Eigen::VectorXd>& rest);

/// Returns the signals behind `shown` (n x N), as they are known at the end of the record: each analysis
/// holds from the sample at which it was taken until the next one is taken. Before the first analysis the
/// signal is what was shown at the start.
Eigen::MatrixXd as_taken(const std::vector<AnalyserTiming>& timings, Eigen::MatrixXd shown);
/// The same for the record of a plant, where changes of `shown` tell when samples are taken
/// (with_first_of()).
Eigen::MatrixXd as_taken_in_record(std::vector<AnalyserTiming> timings, const Eigen::MatrixXd& shown);

}  // namespace mpm
