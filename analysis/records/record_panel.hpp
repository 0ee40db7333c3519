#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/basis/basis_case.hpp"
#include "analysis/methods/assessed_loop.hpp"
#include "analysis/methods/assessment_record.hpp"
#include "analysis/methods/method_panel.hpp"
#include "analysis/methods/ours/fault_comparison.hpp"
#include "analysis/records/channel_error_fit.hpp"
#include "scenarios/loop/plant_record.hpp"
#include "scenarios/study/study.hpp"
#include "solvers/for_each_with_solver.hpp"

// How a record of a plant is judged; the simulated records beside it are judged in the same way.

namespace mpm {

/// The samples at which nothing was recorded: every CV is missing, and MVs and MDs stay where they were.
/// Nobody knows what the inputs did there. If an input really stayed, no harm is done.
std::vector<bool> unknown_samples(const PlantRecord& record);

/// What is fixed before a record of this loop is judged.
struct RecordFrame {
  Study as_kept;  ///< recorded_study(), gaps as they are
  Study closed;   ///< the same with gaps as [data] fills them, for methods that need every sample
  std::vector<std::string> methods;
  BasisCase basis;
  QpSolverFactory factory;
  ForEachWithSolver for_each;    ///< with this factory or one that gives the same answers
  GapFill fill = GapFill::none;  ///< how gaps are filled for those methods
  Eigen::Index unjudged = 0;     ///< samples at the start that only fill the memory of the model
  Eigen::Index settling = 0;     ///< samples after a gap of the inputs that only fill this memory again
  double model_error = 0.0;      ///< errors that the model may have, a standard deviation; 0: it is exact
  bool finds_benchmark = false;  ///< data.benchmark = "found"
  Eigen::MatrixXd y0 = {};       ///< ny x N, the nominal loop; empty: no cost is asked for
  LateCvs late = {};             ///< common_lateness() of the record
  Eigen::Index since = 0;        ///< sample from which kCostSinceNumber counts costs
  std::shared_ptr<const ModelHabit> habit = {};  ///< JudgedRecord::habit of the record
};

/// A record with what the methods of the frame say of it.
struct JudgedRecord {
  AssessedLoop loop;
  std::pair<Eigen::Index, Eigen::Index> benchmark{0, 0};  ///< as PlantRecord::benchmark; chosen or found
  std::shared_ptr<const ModelHabit> habit = {};           ///< record_habit()
  std::vector<AssessmentRecord> said;
};

/// The period in which the model is best while the MVs move (quietest_period()). It is a quarter of the
/// record, or longer if the methods need more samples. Equal numbers: there is none.
std::pair<Eigen::Index, Eigen::Index> best_period(const RecordFrame& frame, const AssessedLoop& loop);

/// The record as the methods see it. Samples in whose past inputs are unknown (before the record, and after
/// unknown_samples()) are not judged until the slowest channel has settled. With a model error, y_sim also
/// contains what no record can tell apart from it, by least squares over the judged samples of each CV i:
///
///   y - y_sim ~ c_i + sum_m a_im exp(-(k - k_m) Ts / T_im),   k >= k_m,
///
/// that is, a constant (the operating point is never known exactly), and the rest of the unknown past from
/// sample k_m on. T_im are the time constants of the channels of the CV.
AssessedLoop judged_loop(const RecordFrame& frame, const PlantRecord& record);

/// The methods of a frame with what they have learnt. Each thread has its own; an answer depends on the
/// record only.
class RecordPanel {
 public:
  /// The frame must outlive the panel. Throws InputError for options of a method that do not fit.
  explicit RecordPanel(const RecordFrame& frame);

  /// Judges a record. If the frame has y0, the answer of model_check_method() also has the costs of the CVs
  /// (cost_of_record()). A benchmark is taken from `healthy`, the same loop without its fault; null: from the
  /// record itself. Throws InputError when no benchmark is found.
  JudgedRecord judge(const PlantRecord& record, const PlantRecord* healthy = nullptr);

 private:
  /// Methods that see the same record and learn the same.
  struct Group {
    std::vector<std::string> methods = {};
    std::vector<std::size_t> places = {};          ///< of these methods in the frame
    std::unique_ptr<MethodPanel> panel = nullptr;  ///< used if the record has no benchmark; made when needed
  };

  const RecordFrame& frame_;
  std::array<Group, 2> groups_;  ///< of RecordFrame::as_kept, then RecordFrame::closed
};

/// Judges the record by these methods only.
JudgedRecord judged_by(const RecordFrame& frame, std::vector<std::string> methods, const PlantRecord& record);

}  // namespace mpm
