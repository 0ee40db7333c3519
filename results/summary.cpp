#include "results/summary.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "analysis/study_aggregate.hpp"
#include "results/reference.hpp"

namespace mpm {
namespace {

constexpr int kMostListed = 10;

std::string number(double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3f}", value);
}

std::string line(const AggregateValue& value, double reported) {
  const bool has_interval = !std::isnan(value.interval.lower);
  return fmt::format(
      "{:<42}{:>8}  {:<16}{:>9}{:>8}\n", value.name, number(value.value),
      has_interval ? fmt::format("[{:.3f}, {:.3f}]", value.interval.lower, value.interval.upper) : "",
      number(reported), value.count);
}

std::string heading(const Campaign& campaign) {
  const Study& study = campaign.study;
  const CampaignInfo& info = campaign.info;
  return fmt::format(
      "{}\n  plant {} ({} CVs, {} MVs, {} MDs), Hp {}, Hc {}, Ts {} {}, {} samples a loop\n"
      "  {} experiments, seed {}, solver {}, {} jobs, {:.1f} s, mpmbench {} ({})\n"
      "  basis case: {}\n",
      study.title, study.plant.name, study.cv_count(), study.mv_count(), study.md_count(),
      study.controller.prediction_horizon, study.controller.control_horizon, study.controller.sample_time,
      study.plant.time_unit, study.simulation.samples, campaign.records.size(), study.seed, info.solver,
      info.jobs, info.seconds, info.mpmbench_version, info.git_sha, campaign.basis.explanation);
}

std::string table(const Study& study, const StudyAggregate& total) {
  std::string with_reference, without;
  for (const AggregateValue& value : named_values(total)) {
    const double reported = reference_value(study, value.name);
    (std::isnan(reported) ? without : with_reference) += line(value, reported);
  }
  std::string text =
      fmt::format("\n{:<42}{:>8}  {:<16}{:>9}{:>8}\n", "", "measured",
                  fmt::format("{:g} % interval", 100 * study.aggregate.confidence), "reported", "n");
  text += with_reference;
  if (!with_reference.empty() && !without.empty())
    text += "\n";
  return text + without;
}

std::string verdict(const Study& study, const ExperimentRecord& record) {
  const auto name = [&](Eigen::Index cv) { return study.plant.cvs[static_cast<std::size_t>(cv)].name; };
  return fmt::format("{} on {}: located {}, I_MPM {}", to_string(record.draw.kind),
                     name(record.draw.true_cv()),
                     record.diagnosis.predicted_cv < 0 ? "none" : name(record.diagnosis.predicted_cv),
                     number(record.diagnosis.indicator.i_mpm));
}

std::string exceptions(const Campaign& campaign, const std::string& archive) {
  std::string failed, wrong;
  int failures = 0, errors = 0;
  for (const ExperimentRecord& record : campaign.records) {
    if (record.status == ExperimentStatus::failed && ++failures <= kMostListed)
      failed += fmt::format("  {}: {}\n", record.draw.index, record.message);
    if (record.wrong() && ++errors <= kMostListed)
      wrong += fmt::format("  mpmbench replay {} {:<6} # {}\n", archive, record.draw.index,
                           verdict(campaign.study, record));
  }
  std::string text;
  if (failures > 0)
    text += fmt::format("\n{} experiments failed:\n{}", failures, failed);
  if (errors > 0)
    text += fmt::format("\n{} impactful experiments have a wrong verdict{}:\n{}", errors,
                        errors > kMostListed ? fmt::format(", the first {}", kMostListed) : "", wrong);
  return text;
}

nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string summary_text(const Campaign& campaign, const std::string& archive) {
  return heading(campaign) + table(campaign.study, aggregate(campaign.study, campaign.records)) +
         exceptions(campaign, archive);
}

std::string summary_json(const Campaign& campaign) {
  const StudyAggregate total = aggregate(campaign.study, campaign.records);
  nlohmann::ordered_json json;
  json["study"] = campaign.study.name;
  json["seed"] = campaign.study.seed;
  json["solver"] = campaign.info.solver;
  json["seconds"] = json_number(campaign.info.seconds);
  json["experiments"] = total.experiments;
  json["failed"] = total.failed;
  json["basis"] = {{"healthy", campaign.basis.healthy}, {"explanation", campaign.basis.explanation}};
  json["aggregates"] = nlohmann::ordered_json::array();
  for (const AggregateValue& value : named_values(total))
    json["aggregates"].push_back({{"name", value.name},
                                  {"description", value.description},
                                  {"value", json_number(value.value)},
                                  {"lower", json_number(value.interval.lower)},
                                  {"upper", json_number(value.interval.upper)},
                                  {"count", value.count},
                                  {"reported", json_number(reference_value(campaign.study, value.name))}});
  return json.dump(2) + "\n";
}

}  // namespace mpm
