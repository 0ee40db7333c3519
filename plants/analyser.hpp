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
  /// The sample s at which what is shown at sample k was taken: the largest first + i period <= k - delay;
  /// -1 before the first analysis is there.
  Eigen::Index taken(Eigen::Index k) const;

  bool operator==(const AnalyserTiming&) const = default;
};

/// Is one of the variables measured by an analyser?
bool has_analysers(const std::vector<AnalyserTiming>& timings);

/// The analysers of all CVs or MDs, one sample after the other: what is shown at sample k is y(taken(k)).
class AnalyserHold {
 public:
  /// One timing a variable; empty: all are measured at every sample.
  explicit AnalyserHold(const std::vector<AnalyserTiming>& timings);

  /// Starts at sample 0 and shows `y` (ny) until the first analyses are there.
  void reset(const Eigen::Ref<const Eigen::VectorXd>& y);
  /// `y` (ny) at the next sample becomes what is shown. Allocates nothing.
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

/// The analyses behind the values that an analyser has shown, `shown` (N), each at the sample at which it was
/// taken; NaN at all other samples, and where an analysis is not there by the end.
Eigen::RowVectorXd analyses(const AnalyserTiming& timing, const Eigen::Ref<const Eigen::RowVectorXd>& shown);

/// The timing with the `first` under which most changes of `shown` (N, NaN where missing) are new analyses.
AnalyserTiming with_first_of(AnalyserTiming timing, const Eigen::Ref<const Eigen::RowVectorXd>& shown);

/// `signals` (n x N) as their analysers show them, `rest` (n) until the first analyses are there.
Eigen::MatrixXd as_shown(const std::vector<AnalyserTiming>& timings, Eigen::MatrixXd signals,
                         const Eigen::Ref<const Eigen::VectorXd>& rest);

/// The signals behind `shown` (n x N), as they are known at the end of the record: each analysis from the
/// sample at which it was taken on, held to the next one. Before the first one it is what was shown at the
/// start.
Eigen::MatrixXd as_taken(const std::vector<AnalyserTiming>& timings, Eigen::MatrixXd shown);
/// The same for the record of a plant, whose changes show when samples are taken (with_first_of()).
Eigen::MatrixXd as_taken_in_record(std::vector<AnalyserTiming> timings, const Eigen::MatrixXd& shown);

}  // namespace mpm
