#include "analysis/records/record_repair.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "analysis/records/channel_information.hpp"
#include "analysis/records/fitted_repair.hpp"
#include "analysis/records/model_check.hpp"
#include "base/error.hpp"
#include "base/non_finite.hpp"

namespace mpm {
namespace {

/// The record since the onset of the fault: earlier samples count in no repair.
AssessedLoop since_onset(const RecordAssessment& assessment) {
  AssessedLoop loop = assessment.loop;
  if (assessment.verdict.model.since)
    loop.y.leftCols(assessment.verdict.model.since->sample).setConstant(kNaN);
  return loop;
}

/// The samples at which some CV is judged: only these count in what a repair would bring.
std::vector<bool> counted_samples(const AssessedLoop& loop) {
  std::vector<bool> counted(static_cast<std::size_t>(loop.samples()));
  for (std::size_t k = 0; k < counted.size(); ++k)
    counted[k] = !loop.y.col(static_cast<Eigen::Index>(k)).array().isNaN().all();
  return counted;
}

/// Repairs the channel of the mismatch that `mpmbench` names, or else the channel that `likelihood` names, or
/// else the one that `mpmbench` names without a mismatch. If the mismatch is not at the CV that the verdict
/// names, the first channel that the answer names at that CV is repaired instead. If neither names a channel,
/// the likeliest one is repaired. If the model has errors of known size, the channel is identified again
/// beside them.
std::optional<ChannelRepair> repair_of(const RecordAssessment& assessment, const AssessedLoop& loop,
                                       const RecordFrame& frame,
                                       const std::optional<NamedMismatch>& likeliest) {
  const Study& study = assessment.study;
  const OperatingPoint& point = frame.basis.point;
  const Eigen::Index dearest = assessment.verdict.named_cv();
  const AssessmentRecord* answer = nullptr;
  for (const AssessmentRecord* const said : {&assessment.sources, &assessment.odds})
    if (channel_to_repair(*said) && (answer == nullptr || !answer->named_mismatch()))
      answer = said;
  const auto identified = [&](const Channel& channel, const std::optional<MismatchParameter>& only) {
    return frame.model_error > 0.0 ? fitted_repair(study, point, assessment.loop, channel, only,
                                                   frame.model_error, assessment.verdict.model.since)
                                   : identified_channel(study, point, loop, channel, only);
  };
  if (answer == nullptr)
    return likeliest ? std::optional(identified(likeliest->channel, likeliest->parameter)) : std::nullopt;
  const std::optional<NamedMismatch> named = answer->named_mismatch();
  for (Eigen::Index mv = 0; named && named->channel.cv != dearest && mv < study.mv_count(); ++mv)
    if (answer->names({dearest, mv}))
      return identified({dearest, mv}, {});
  if (frame.model_error > 0.0 && (!named || is_fitted_alone(named->parameter)))
    return identified(*channel_to_repair(*answer), named ? std::optional(named->parameter) : std::nullopt);
  return channel_repair(study, point, loop, *answer);
}

/// The repair of a channel as a mismatch. For a channel that was identified again as a whole, this is its
/// gain if it differs from the model's.
NamedMismatch mismatch_of(const ChannelRepair& repair) {
  if (repair.named)
    return *repair.named;
  const bool has_gain = repair.gain_factor.upper < 1.0 || repair.gain_factor.lower > 1.0;
  const MismatchParameter parameter =
      repair.parameter.value_or(has_gain ? MismatchParameter::gain : MismatchParameter::channel);
  const FittedNumber* const size = parameter == MismatchParameter::gain            ? &repair.gain_factor
                                   : parameter == MismatchParameter::time_constant ? &repair.time_factor
                                   : parameter == MismatchParameter::dead_time     ? &repair.dead_time_shift
                                                                                   : nullptr;
  return size == nullptr
             ? NamedMismatch{repair.channel, parameter}
             : NamedMismatch{repair.channel, parameter, size->value, size->lower, size->upper, size->bound};
}

/// Is the parameter that is named perhaps that of the model? Then there is no mismatch beside a disturbance.
bool is_as_modelled(const NamedMismatch& mismatch) {
  return is_fitted_alone(mismatch.parameter) &&
         mismatch.holds(mismatch.parameter == MismatchParameter::dead_time ? 0.0 : 1.0);
}

}  // namespace

void add_repair(RecordAssessment& assessment, const RecordFrame& frame, VerdictEvidence& evidence) {
  if (!assessment.verdict.model.has_mismatch())
    return;
  const Study& study = assessment.study;
  const OperatingPoint& point = frame.basis.point;
  const AssessedLoop loop = since_onset(assessment);
  const std::vector<bool> counted = counted_samples(loop);
  try {
    std::optional<RepairedChannel> named;
    if (const auto repair =
            evidence.md < 0 ? repair_of(assessment, loop, frame, evidence.likeliest) : std::nullopt) {
      evidence.mismatch = mismatch_of(*repair);
      if (assessment.verdict.model.source == RecordSource::both && is_as_modelled(*evidence.mismatch)) {
        std::swap(evidence.weights.of[RecordSource::both], evidence.weights.of[RecordSource::disturbance]);
        return;
      }
      assessment.repair = promised_repair(study, point, loop, *repair, frame.factory, counted);
      assessment.information =
          channel_information(study, loop, repair->channel,
                              frame.model_error > 0.0 ? frame.model_error : study.assessment.model_error);
      evidence.tells_apart = assessment.information->rank == assessment.information->parameters;
      named = repair->repaired();
    }
    if (auto prospects = RepairProspects(study, point, frame.for_each).of(loop, named, counted))
      assessment.prospects = ranked(std::move(*prospects));
  } catch (const InputError& error) {
    assessment.no_repair = error.what();
  }
  const RepairProspect* const prospect = assessment.named_prospect();
  if (prospect == nullptr || prospect->gains.empty())
    return;
  evidence.promise = {prospect->gain(), prospect->gains.front(), prospect->gains.back(),
                      prospect->variance_ratio};
  evidence.worth = study.assessment.of<AdequacyOptions>().worth;
}

bool is_mismatch_alone(const RecordAssessment& assessment, const RecordFrame& frame) {
  if (!assessment.repair || frame.model_error == 0.0 ||
      assessment.record.benchmark.first < assessment.record.benchmark.second ||
      !assessment.record.y_sim.array().isNaN().all())
    return false;
  RecordFrame repaired = frame;
  const ChannelRepair& repair = assessment.repair->repair;
  for (Study* const of : {&repaired.as_kept, &repaired.closed})
    of->plant.G(repair.channel.cv, repair.channel.mv) = repair.model;
  PlantRecord record = assessment.record;
  if (const std::optional<FaultOnset>& since = assessment.verdict.model.since)
    record.y.leftCols((since->sample + record.samples()) / 2).setConstant(kNaN);
  const AssessmentRecord said = judged_by(repaired, {kModelCheck}, record).said.front();
  return said.answered() && said.score <= assessment.model_threshold();
}

}  // namespace mpm
