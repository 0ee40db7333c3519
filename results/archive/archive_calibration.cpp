// The scores of the calibration loops. The thresholds follow from the scores: they are findings and are not
// read back.

#include <array>
#include <numeric>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/row_io.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/loop/calibration.hpp"

namespace mpm {
namespace {

constexpr const char* kCalibrationGroup = "calibration";
constexpr const char* kLoopDimension = "loop";

std::vector<Row<CalibrationLoop>> loop_score_rows(std::size_t methods) {
  const auto itself = [](auto& score) -> auto& {
    return score;
  };
  return {member_row<std::int8_t>({"kind", "what is wrong in the loop", "1", "",
                                   enum_words(std::array{ExperimentKind::healthy, ExperimentKind::ud})},
                                  &CalibrationLoop::kind),
          of_each<CalibrationLoop>(
              member_row<double, double>({"score", "how far the loop is from being flagged, larger is worse",
                                          "1", "NaN: no verdict; -infinity: a verdict without a score"},
                                         itself),
              "method", methods, &CalibrationLoop::scores)};
}

/// Throws ArchiveError if a property of the group differs from the study.
void require_equal(std::uint64_t found, std::uint64_t expected, const char* what, const std::string& file) {
  if (found != expected)
    throw ArchiveError(fmt::format("{}: {} of '/{}': found {}; allowed: {}", file, what, kCalibrationGroup,
                                   found, expected));
}

}  // namespace

void write_calibration(Hdf5Group& root, const Campaign& campaign) {
  if (!campaign.study.calibration)
    return;
  const std::vector<CalibrationLoop>& loops = campaign.calibration.loops;
  Hdf5Group group = root.create_group(kCalibrationGroup);
  group.write_attribute("title", "Scores of the methods on loops of another seed, for thresholds");
  group.write_attribute("seed", campaign.calibration.seed);
  group.write_attribute("false_alarms", campaign.study.calibration->false_alarms);
  std::vector<std::int64_t> numbers(loops.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  group.write_dimension(kLoopDimension, numbers,
                        attributes<std::int64_t>({kLoopDimension, "number of the loop"}));
  group.write_dimension("method", method_names(campaign),
                        attributes<std::string>({"method", "method of assessment"}));
  store_rows(group, {kLoopDimension}, loop_score_rows(campaign.methods.size()), loops);
}

Calibration read_calibration(const Hdf5Group& root, const Campaign& campaign, const std::string& file) {
  if (!campaign.study.calibration)
    return {};
  const Hdf5Group group = root.group(kCalibrationGroup);
  const Study expected = calibration_study(campaign.study);
  Calibration calibration{group.attribute<std::uint64_t>("seed"), {}};
  require_equal(calibration.seed, expected.seed, "seed", file);
  if (group.read_list<std::string>("method") != method_names(campaign))
    throw ArchiveError(
        fmt::format("{}: variable '/{}/method': found other methods; allowed: those of '/method'", file,
                    kCalibrationGroup));
  const auto count = static_cast<std::size_t>(expected.experiment_count());
  require_equal(group.read_list<std::int64_t>(kLoopDimension).size(), count, "number of loops", file);
  calibration.loops.resize(count);
  load_rows(group, loop_score_rows(campaign.methods.size()), calibration.loops, file);
  return calibration;
}

}  // namespace mpm
