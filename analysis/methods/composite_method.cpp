#include "analysis/methods/composite_method.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace mpm {
namespace {

/// The two methods that are asked. Assessors refer to them only by name, so these may be copies.
struct Parts {
  AssessmentMethodInfo detector, namer;
};

class CompositeMethod final : public AssessmentMethod {
 public:
  CompositeMethod(const Parts& parts, const AssessmentContext& context)
      : detector_(shared_assessor(parts.detector, context)),
        namer_(shared_assessor(parts.namer, context)),
        tells_sources_(parts.namer.tells_sources) {}

  Assessment assess(const AssessedLoop& loop) override {
    Assessment found = detector_->assess(loop);
    if (found.status != AssessmentStatus::ok)
      return found;
    const Assessment named = namer_->assess(loop);
    Assessment both = named.status == AssessmentStatus::ok ? named : Assessment{};
    both.flagged = found.flagged;
    both.score = found.score;
    both.numbers.clear();
    if (!named.flagged && (both.cvs.empty() || found.worst_cv()))
      both.cvs = std::move(found.cvs);
    const std::optional<Eigen::Index> worst = both.worst_cv();
    if (tells_sources_ && worst && named.status == AssessmentStatus::ok && !named.flagged)
      both.cvs[static_cast<std::size_t>(*worst)].source = FaultSource::ud;
    if (!both.flagged)
      for (CvAssessment& cv : both.cvs)
        cv.flagged = cv.flagged ? std::optional(false) : std::nullopt;
    return both;
  }

 private:
  std::shared_ptr<Assessor> detector_, namer_;
  bool tells_sources_;
};

}  // namespace

AssessmentMethodInfo composite_method(const std::string& name, const AssessmentMethodInfo& detector,
                                      const AssessmentMethodInfo& namer) {
  return {{.name = name,
           .title = fmt::format("{} detects, {} names", detector.name, namer.name),
           .verdict = detector.verdict,
           .requirements = {.complete_record = false},
           .locates_cvs = detector.locates_cvs || namer.locates_cvs,
           .names_channels = namer.names_channels,
           .tells_sources = namer.tells_sources,
           .names_mismatches = namer.names_mismatches,
           .names_candidates = namer.names_candidates,
           .information = ModelInformation::unused,
           .stated_false_alarms = detector.stated_false_alarms,
           .numbers = {}},
          {},
          [parts = Parts{detector, namer}](const AssessmentContext& context) {
            return std::make_unique<CompositeMethod>(parts, context);
          },
          {},
          detector.states_false_alarms};
}

}  // namespace mpm
