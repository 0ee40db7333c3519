#include "results/assess/repair_form.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "results/plot/plot_text.hpp"
#include "results/text/experiment_text.hpp"

namespace mpm {
namespace {

std::string fitted_text(const FittedNumber& number) {
  return estimate_text(number.value, number.lower, number.upper, number.bound);
}

std::string parameter_words(MismatchParameter parameter) {
  return parameter == MismatchParameter::gain            ? "gain"
         : parameter == MismatchParameter::time_constant ? "time constants"
                                                         : "dead time";
}

nlohmann::ordered_json fitted_json(const FittedNumber& number) {
  return {{"value", number.value},
          {"lower", number.lower},
          {"upper", number.upper},
          {"bound", to_string(number.bound)}};
}

/// Returns the size of the only parameter that is corrected.
FittedNumber size_of(const ChannelRepair& repair) {
  if (repair.named)
    return {repair.named->size, repair.named->lower, repair.named->upper, repair.named->bound};
  return *repair.parameter == MismatchParameter::gain            ? repair.gain_factor
         : *repair.parameter == MismatchParameter::time_constant ? repair.time_factor
                                                                 : repair.dead_time_shift;
}

}  // namespace

std::string channel_name(const Study& study, const Channel& channel) {
  return fmt::format("{}/{}", cv_name(study, channel.cv), mv_name(study, channel.mv));
}

std::string correction_text(const Study& study, const ChannelRepair& repair) {
  const FittedNumber& shift = repair.dead_time_shift;
  const std::string gain = fmt::format("{} times the gain", fitted_text(repair.gain_factor));
  const std::string time = fmt::format("{} times the time constants", fitted_text(repair.time_factor));
  const std::string dead_time = "a dead time " + dead_time_text(shift.value, shift.lower, shift.upper,
                                                                shift.bound, study.plant.time_unit);
  if (!repair.parameter)
    return fmt::format("{}, {} and {}", gain, time, dead_time);
  const auto alone = [](const std::string& what) { return what + ", all else as in the model"; };
  const auto added = [&](const char* what) {
    return alone(
        fmt::format("a further {} of {} {}", what, fitted_text(size_of(repair)), study.plant.time_unit));
  };
  switch (*repair.parameter) {
    case MismatchParameter::time_constant:
      return alone(time);
    case MismatchParameter::dead_time:
      return alone(dead_time);
    case MismatchParameter::second_order:
      return added("lag");
    case MismatchParameter::inverse_response:
      return added("inverse response");
    case MismatchParameter::gain:
    case MismatchParameter::sign:
    case MismatchParameter::channel:
      break;
  }
  return alone(gain);
}

std::vector<std::string> worsened_cvs(const Study& study, const RepairProspect& prospect) {
  return worsened_cvs(study, {}, {}, &prospect);
}

std::vector<std::string> worsened_cvs(const Study& study, const Eigen::VectorXd& now,
                                      const Eigen::VectorXd& then, const RepairProspect* prospect) {
  std::vector<std::string> worse;
  for (Eigen::Index cv = 0; cv < study.cv_count(); ++cv) {
    const bool promised = cv < std::min(now.size(), then.size()) && then(cv) > kNoticeableChange * now(cv);
    if (promised || (prospect != nullptr && cv < prospect->variance_ratio.size() &&
                     prospect->variance_ratio(cv) > kNoticeableChange))
      worse.push_back(cv_name(study, cv));
  }
  return worse;
}

std::string information_sentence(const Study& study, const Channel& channel, const ChannelInformation& told) {
  constexpr double kActAlike = 1000.0;  // condition at which the others give a column to 3 %
  const std::string name = channel_name(study, channel);
  const std::string measured =
      fmt::format("rank {} of {}, condition {:.2g}", told.rank, told.parameters, told.condition);
  if (told.rank == told.parameters && told.condition < kActAlike)
    return fmt::format("The record tells the parameters of {} apart ({}).", name, measured);
  std::vector<std::string> alike;
  for (const MismatchParameter parameter : told.alike)
    alike.push_back(parameter_words(parameter));
  return fmt::format("The record does not tell {} of {} apart ({}): a test of the channel with steps would.",
                     fmt::join(alike, " and "), name, measured);
}

Table prospects_table(const Study& study, const std::vector<RepairProspect>& prospects) {
  const double worth = study.assessment.of<AdequacyOptions>().worth;
  Table table(fmt::format("Channels by the share of the cost of the loop that their repair saves, in %: the "
                          "expected share, and the probability that it is above {:g} %. A repair is proposed "
                          "if it saves cost and worsens no CV by more than {:.0f} %.",
                          100.0 * worth, 100.0 * (kNoticeableChange - 1.0)),
              {{"channel", Table::Align::left},
               {"expected"},
               {fmt::format("above {:g} %", 100.0 * worth)},
               {"worsens", Table::Align::left}});
  for (const RepairProspect& prospect : prospects) {
    const std::vector<std::string> worse = worsened_cvs(study, prospect);
    const std::string name = as_label(channel_name(study, prospect.repair.channel));
    table.row({prospect.is_proposed() ? Cell(strong(name)) : Cell(name),
               Number{prospect.gain(), NumberForm::whole_percent},
               Number{prospect.probability_above(worth), NumberForm::whole_percent}, listed(worse, "-")});
  }
  return table;
}

nlohmann::ordered_json repair_json(const ChannelRepair& repair) {
  const auto list = [](const Eigen::VectorXd& of) { return std::vector<double>(of.begin(), of.end()); };
  return {{"parameter", repair.parameter ? nlohmann::ordered_json(to_string(*repair.parameter))
                                         : nlohmann::ordered_json()},
          {"size", repair.parameter ? fitted_json(size_of(repair)) : nlohmann::ordered_json()},
          {"estimated_by", repair.named ? "verdict" : "fit"},
          {"gain_factor", fitted_json(repair.gain_factor)},
          {"time_factor", fitted_json(repair.time_factor)},
          {"dead_time_shift", fitted_json(repair.dead_time_shift)},
          {"explained", std::isnan(repair.explained) ? nlohmann::ordered_json()
                                                     : nlohmann::ordered_json(repair.explained)},
          {"transfer_function",
           {{"numerator", list(repair.model.numerator())},
            {"denominator", list(repair.model.denominator())},
            {"dead_time", repair.model.dead_time()}}}};
}

nlohmann::ordered_json information_json(const ChannelInformation& told) {
  nlohmann::ordered_json alike = nlohmann::ordered_json::array();
  for (const MismatchParameter parameter : told.alike)
    alike.push_back(to_string(parameter));
  return {{"parameters", told.parameters},
          {"rank", told.rank},
          {"condition",
           std::isfinite(told.condition) ? nlohmann::ordered_json(told.condition) : nlohmann::ordered_json()},
          {"alike", alike}};
}

nlohmann::ordered_json prospects_json(const Study& study, const std::vector<RepairProspect>& prospects) {
  const double worth = study.assessment.of<AdequacyOptions>().worth;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const RepairProspect& prospect : prospects)
    json.push_back({{"cv", cv_name(study, prospect.repair.channel.cv)},
                    {"mv", mv_name(study, prospect.repair.channel.mv)},
                    {"gain", prospect.gain()},
                    {"worth", worth},
                    {"p_worth", prospect.probability_above(worth)},
                    {"variance_ratio",
                     std::vector<double>(prospect.variance_ratio.begin(), prospect.variance_ratio.end())},
                    {"worsens", worsened_cvs(study, prospect)},
                    {"proposed", prospect.is_proposed()}});
  return json;
}

}  // namespace mpm
