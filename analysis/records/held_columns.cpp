#include "analysis/records/held_columns.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/statistics/signal_look.hpp"
#include "analysis/study_files/recorded_study.hpp"
#include "plants/analyser.hpp"

namespace mpm {
namespace {

/// The values that are there.
SignalLook look_at(const Eigen::RowVectorXd& y) {
  std::vector<double> values;
  for (const double value : y)
    if (!std::isnan(value))
      values.push_back(value);
  return SignalLook(std::move(values));
}

}  // namespace

Study with_held_columns(const Study& study, PlantRecord& record) {
  std::map<std::string, int> periods;
  std::vector<std::string> warnings;
  for (Eigen::Index cv = 0; cv < record.y.rows(); ++cv) {
    const std::vector<AnalyserTiming>& known = study.controller.analysers;
    if (!known.empty() && known[static_cast<std::size_t>(cv)].is_analyser())
      continue;
    const std::string& name = study.plant.cvs[static_cast<std::size_t>(cv)].name;
    const SignalLook look = look_at(record.y.row(cv));
    if (const std::optional<std::size_t> period = look.period()) {
      periods[name] = static_cast<int>(*period);
      warnings.push_back(fmt::format(
          "{} has a new value every {} samples only, as of an analyser: only its new values count. "
          "analyser_period = {} in [controller.cv.{}] says so, and analyser_delay by how much it is late",
          name, *period, *period, name));
    } else if (const std::optional<std::size_t> gap = look.usual_gap(); gap && *gap > 1) {
      warnings.push_back(fmt::format(
          "{} has a new value in {:.0f} % of the samples only, most often every {} samples: held values "
          "count as measured. If an analyser measures it, name its period (analyser_period in "
          "[controller.cv.{}]); if it was stored only on change, export it at least every sample",
          name, 100.0 * look.changes, *gap, name));
    }
  }
  record.warnings.insert(record.warnings.begin(), warnings.begin(), warnings.end());
  return periods.empty() ? study : with_analysers(study, periods);
}

}  // namespace mpm
