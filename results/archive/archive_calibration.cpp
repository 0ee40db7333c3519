// The scores of the calibration loops. The thresholds follow from them: they are findings, and not read back.

#include <array>
#include <numeric>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/columns.hpp"
#include "results/archive/variable_text.hpp"
#include "results/files/archive_error.hpp"
#include "scenarios/loop/calibration.hpp"

namespace mpm {
namespace {

constexpr const char* kCalibrationGroup = "calibration";
constexpr const char* kLoopDimension = "loop";

VariableText kind_text() {
  return {"kind", "what is wrong in the loop", "1", "",
          enum_flags(std::array{ExperimentKind::healthy, ExperimentKind::ud})};
}

VariableText score_text() {
  return {"score", "how far the loop is from being flagged, larger is worse", "1",
          "NaN: no verdict; -infinity: a verdict without a score"};
}

/// Throws ArchiveError when a property of the group is not that of the study.
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
  group.write_attribute("title", "What the methods say of loops of another seed, for thresholds");
  group.write_attribute("seed", campaign.calibration.seed);
  group.write_attribute("false_alarms", campaign.study.calibration->false_alarms);
  std::vector<std::int64_t> numbers(loops.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  group.write_dimension(kLoopDimension, numbers,
                        attributes<std::int64_t>({kLoopDimension, "number of the loop"}));
  group.write_dimension("method", method_names(campaign),
                        attributes<std::string>({"method", "method of assessment"}));
  std::vector<std::int8_t> kinds;
  std::vector<double> scores;
  for (const CalibrationLoop& loop : loops) {
    kinds.push_back(static_cast<std::int8_t>(loop.kind));
    scores.insert(scores.end(), loop.scores.begin(), loop.scores.end());
  }
  group.write("kind", {kLoopDimension}, kinds, attributes<std::int8_t>(kind_text()));
  group.write("score", {kLoopDimension, "method"}, scores, attributes<double>(score_text()));
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
  const std::vector<std::int8_t> kinds = group.read<std::int8_t>("kind", {count});
  require_flags(kind_text(), kinds, file);
  const std::size_t methods = campaign.methods.size();
  const std::vector<double> scores = group.read<double>("score", {count, methods});
  for (std::size_t loop = 0; loop < count; ++loop) {
    const auto begin = scores.begin() + static_cast<std::ptrdiff_t>(loop * methods);
    calibration.loops.push_back(
        {static_cast<ExperimentKind>(kinds[loop]), {begin, begin + static_cast<std::ptrdiff_t>(methods)}});
  }
  return calibration;
}

}  // namespace mpm
