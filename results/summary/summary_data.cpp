#include "results/summary/summary_data.hpp"

#include <nlohmann/json.hpp>

#include "analysis/methods/thesis/chain_numbers.hpp"
#include "analysis/sensitivity/box_jenkins_sensitivity.hpp"
#include "analysis/sensitivity/loop_interaction.hpp"
#include "results/files/utf8.hpp"
#include "results/text/experiment_text.hpp"
#include "results/text/scenario_text.hpp"

namespace mpm {
namespace {

using Json = nlohmann::ordered_json;

Json names(const std::vector<PlantModel::Variable>& variables) {
  Json list = Json::array();
  for (const PlantModel::Variable& variable : variables)
    list.push_back(variable.name);
  return list;
}

Json settings_json(const Study& study) {
  return {{"title", study.title},
          {"plant", study.plant.name},
          {"cvs", names(study.plant.cvs)},
          {"mvs", names(study.plant.mvs)},
          {"mds", names(study.plant.mds)},
          {"time_unit", study.plant.time_unit},
          {"sample_time", study.controller.sample_time},
          {"prediction_horizon", study.controller.prediction_horizon},
          {"control_horizon", study.controller.control_horizon},
          {"samples", study.simulation.samples}};
}

Json run_json(const CampaignInfo& info) {
  return {{"mpmbench_version", info.mpmbench_version},
          {"git_sha", info.git_sha},
          {"created", info.created},
          {"command", proper_utf8(info.command)},
          {"jobs", info.jobs}};
}

/// Returns the value of `number` for each row; a verdict as its word.
template <class Owner, class Number>
Json numbers_json(const std::vector<Row<Owner>>& rows, const Number& number) {
  Json numbers = Json::object();
  for (const Row<Owner>& row : rows) {
    const double value = number(row);
    const std::string* const word = word_for(row.text.words, value);
    numbers[row.text.name] = word == nullptr ? Json(value) : Json(*word);
  }
  return numbers;
}

Json interaction_json(const Study& study, const BasisCase& basis) {
  const LoopInteraction interaction = loop_interaction(study, basis.point, basis.sensitivity);
  Json gains = Json::array();
  for (std::size_t i = 0; i < interaction.mvs.size(); ++i)
    for (std::size_t j = 0; j < interaction.mvs.size(); ++j)
      gains.push_back({{"cv", study.plant.cvs[static_cast<std::size_t>(interaction.cvs[i])].name},
                       {"mv", mv_name(study, interaction.mvs[j])},
                       {"value", interaction.relative_gain_at_maximum(static_cast<Eigen::Index>(i),
                                                                      static_cast<Eigen::Index>(j))}});
  return {{"rpn_frequency", interaction.rpn_frequency},
          {"rpn_maximum", interaction.rpn_maximum},
          {"relative_gains", gains}};
}

Json basis_json(const Study& study, const BasisCase& basis) {
  Json ivar = Json::object();
  for (Eigen::Index cv = 0; cv < basis.diagnosis.ivar.size(); ++cv)
    ivar[study.plant.cvs[static_cast<std::size_t>(cv)].name] = basis.diagnosis.ivar(cv);
  Json differences = Json::object();
  if (basis.sensitivity_direct) {
    const Eigen::VectorXd largest = largest_differences(basis.sensitivity, *basis.sensitivity_direct);
    for (Eigen::Index a = 0; a < largest.size(); ++a)
      differences[study.plant
                      .cvs[static_cast<std::size_t>(basis.sensitivity.active[static_cast<std::size_t>(a)].cv)]
                      .name] = largest(a);
  }
  Json acf = Json::object();
  for (std::size_t cv = 0; cv < basis.diagnosis.cvs.size(); ++cv)
    acf[study.plant.cvs[cv].name] = numbers_json(acf_rows(), [&](const Row<AcfComparison>& row) {
      return numbers_of(row, basis.diagnosis.cvs[cv].acf).front();
    });
  return {{"healthy", basis.healthy},
          {"explanation", basis.explanation},
          {"ivar", ivar},
          {"acf", acf},
          {"t0_difference", differences},
          {"interaction", interaction_json(study, basis)}};
}

Json kinds_json(const std::vector<KindCount>& counts) {
  Json kinds = Json::object();
  for (const KindCount& count : counts)
    kinds[std::string(to_string(count.kind))] = count.experiments;
  return kinds;
}

Json findings_json(const std::vector<Finding>& rows, double confidence) {
  Json list = Json::array();
  for (const Finding& row : rows) {
    const std::optional<bool> agrees = row.agrees(confidence);
    list.push_back({{"name", row.name},
                    {"meaning", row.meaning},
                    {"form", to_string(row.form)},
                    {"value", row.value},
                    {"lower", row.interval.lower},
                    {"upper", row.interval.upper},
                    {"count", row.count},
                    {"reported", row.reported},
                    {"reported_of", row.reported_of > 0 ? Json(row.reported_of) : Json()},
                    {"agrees", agrees ? Json(*agrees) : Json()}});
  }
  return list;
}

Json dominance_json(const std::vector<DominanceBin>& bins) {
  Json list = Json::array();
  for (const DominanceBin& bin : bins)
    list.push_back({{"lower", bin.lower},
                    {"upper", bin.upper},
                    {"count", bin.i_mpm.count},
                    {"i_mpm_mean", bin.i_mpm.mean},
                    {"i_mpm_mean_lower", bin.i_mpm.mean_interval.lower},
                    {"i_mpm_mean_upper", bin.i_mpm.mean_interval.upper},
                    {"above_threshold", bin.above_threshold.value}});
  return list;
}

Json audit_json(const SummaryContent& parts, const CampaignInfo& info) {
  return {{"share", info.audit_share},
          {"steps", parts.audit.steps},
          {"disagreements", parts.audit.disagreements},
          {"largest_target", parts.audit.largest_target},
          {"largest_move", parts.audit.largest_move},
          {"largest_objective", parts.audit.largest_objective},
          {"seconds", info.audit_seconds},
          {"fallbacks", parts.fallbacks}};
}

Json change_json(const S0Change& change) {
  return {{"largest_change", change.largest}, {"within_band", change.within_band.value}};
}

Json s0_perturbation_json(const Study& study, const SummaryContent& parts) {
  const auto name = [&](Eigen::Index cv) { return study.plant.cvs[static_cast<std::size_t>(cv)].name; };
  Json fits = Json::array(), curves = Json::array(), structures = Json::array();
  for (const DiagonalFit& fit : parts.s0_fits)
    fits.push_back({{"cv", name(fit.cv)},
                    {"time_constant", fit.fit.model.time_constant},
                    {"damping", fit.fit.model.damping},
                    {"rms_error", fit.fit.rms_error}});
  for (const S0Curve& curve : parts.s0_curves)
    curves.push_back({{"cv", name(curve.cv)},
                      {"experiments", curve.experiments},
                      {"time_constant", change_json(curve.time_constant_change)},
                      {"damping", change_json(curve.damping_change)}});
  for (const StructureFit& fit : parts.structure_fits)
    structures.push_back({{"cv", name(fit.cv)},
                          {"time_constant", fit.fixed.model.time_constant},
                          {"damping", fit.fixed.model.damping},
                          {"time_constant_multiplier", fit.time_constant_multiplier},
                          {"damping_multiplier", fit.damping_multiplier}});
  return {{"fits", fits}, {"changes", curves}, {"fixed_mvs", structures}};
}

Json cv_json(const Study& study, const ExperimentRecord& record, Eigen::Index cv) {
  const AssessmentRecord& said = record.chain();
  const auto of_cv = [&](const auto& row) { return said.number("cv_" + row.text.name, cv); };
  return {{"cv", cv_name(study, cv)},
          {"ivar", said.number("ivar", cv)},
          {"ivar_diag", said.number("ivar_diag", cv)},
          {"ivar_basis", record.ivar_basis(cv)},
          {"flagged", said.flags(cv)},
          {"source", to_string(said.source_on(cv))},
          {"i_mpm", said.number("cv_i_mpm", cv)},
          {"co_dkts", said.number("cv_co_dkts", cv)},
          {"co_dskn", said.number("cv_co_dskn", cv)},
          {"sse", said.number("cv_sse", cv)},
          {"distribution", numbers_json(distribution_rows(), of_cv)},
          {"acf", numbers_json(acf_rows(), of_cv)}};
}

/// Lists the named scenarios; the list is empty in a study of random experiments.
Json scenarios_json(const Campaign& campaign) {
  const Study& study = campaign.study;
  Json list = Json::array();
  for (const ExperimentRecord& record : campaign.records) {
    if (!record.draw.named)
      continue;
    const AssessmentRecord& chain = record.chain();
    Json affected = Json::object(), cvs = Json::array();
    for (const AffectedCv& cv : record.draw.affected())
      affected[study.plant.cvs[static_cast<std::size_t>(cv.cv)].name] = to_string(cv.by);
    for (Eigen::Index cv = 0; chain.answered() && cv < study.cv_count(); ++cv)
      cvs.push_back(cv_json(study, record, cv));
    list.push_back({{"index", record.draw.index},
                    {"name", scenario_name(study, record)},
                    {"description", study.scenarios[static_cast<std::size_t>(record.draw.index)].description},
                    {"kind", to_string(record.draw.kind)},
                    {"fault", fault_text(study, record.draw)},
                    {"status", to_string(record.status)},
                    {"affected", affected},
                    {"verdict", scenario_verdict_text(study, record)},
                    {"tsse", total_simulation_error(chain)},
                    {"cvs", cvs}});
  }
  return list;
}

Json failures_json(const std::vector<FailedExperiment>& failed) {
  Json list = Json::array();
  for (const FailedExperiment& experiment : failed)
    list.push_back({{"index", experiment.index}, {"message", proper_utf8(experiment.message)}});
  return list;
}

}  // namespace

void put_run(Json& json, const Campaign& campaign, const SummaryContent& parts,
             const std::optional<Unfinished>& unfinished) {
  const StudyFindings& total = parts.findings;
  json.update(
      {{"partial",
        unfinished ? Json{{"done", unfinished->done}, {"experiments", unfinished->experiments}} : Json()},
       {"study", campaign.study.name},
       {"seed", campaign.study.seed},
       {"solver", campaign.info.solver},
       {"controller_program",
        campaign.study.controller_program ? Json(campaign.study.controller_program->command()) : Json()},
       {"outside_files", campaign.info.outside_files},
       {"seconds", campaign.info.seconds},
       {"experiments", total.experiments},
       {"infeasible", total.infeasible.hits},
       {"failed", total.failed},
       {"unstable", total.unstable.total > 0 ? Json(total.unstable.hits) : Json()},
       {"excluded", total.excluded},
       {"kinds", kinds_json(parts.kinds)},
       {"basis", basis_json(campaign.study, campaign.basis)},
       {"settings", settings_json(campaign.study)},
       {"run", run_json(campaign.info)},
       {"confidence", campaign.study.aggregate.confidence},
       {"methods", method_names(campaign)}});
}

void put_findings(Json& json, const Study& study, const SummaryContent& parts) {
  json["findings"] = findings_json(parts.findings.rows, study.aggregate.confidence);
  json["dominance"] = dominance_json(parts.findings.dominance);
  json["s0_perturbation"] = s0_perturbation_json(study, parts);
}

void put_scenarios(Json& json, const Campaign& campaign) {
  json["scenarios"] = scenarios_json(campaign);
}

void put_experiments(Json& json, const CampaignInfo& info, const SummaryContent& parts) {
  json["audit"] = audit_json(parts, info);
  json["failures"] = failures_json(parts.failures);
  json["wrong_verdicts"] = parts.wrong_verdicts;
}

}  // namespace mpm
