#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "scenarios/files/study_file_keys.hpp"
#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/toml/toml_values.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxOrder = 100;
constexpr std::int64_t kMaxLag = 1'000'000;
constexpr std::int64_t kMaxLength = 1000;  // of filters and lags, in samples
constexpr std::int64_t kMaxIterations = 100'000;

/// A list of whole numbers.
std::vector<int> read_orders(const TomlTable& table, const std::vector<int>& fallback) {
  if (!table.has("orders")) {
    table.record("orders", fallback);
    return fallback;
  }
  std::vector<int> orders;
  const NumberRule rule{.low = 1, .high = kMaxOrder, .low_included = true, .high_included = true};
  for (const double order : read_numbers(table, "orders", rule, kMaxOrder)) {
    if (order != std::floor(order))
      table.refuse("orders", fmt::format("{}", order), "whole numbers");
    orders.push_back(static_cast<int>(order));
  }
  table.record("orders", orders);  // as whole numbers
  return orders;
}

int read_int_or(const TomlTable& table, std::string_view key, std::int64_t low, std::int64_t high,
                int fallback) {
  return static_cast<int>(read_whole_or(table, key, low, high, fallback));
}

SunOptions read_sun(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("sun", study_file_keys("assessment.sun"));
  SunOptions options;
  options.tolerance = read_number_or(table, "tolerance", NumberRule::positive(), options.tolerance);
  options.index = read_choice_or<SunIndex>(table, "index", {{"imqi", SunIndex::imqi}, {"mqi", SunIndex::mqi}},
                                           options.index);
  options.orders = read_orders(table, options.orders);
  options.setpoint_order = read_int_or(table, "setpoint_order", 0, kMaxOrder, options.setpoint_order);
  options.criterion = read_choice_or<SunCriterion>(
      table, "criterion",
      {{"aic", SunCriterion::aic}, {"bic", SunCriterion::bic}, {"validation", SunCriterion::validation}},
      options.criterion);
  options.own_outputs = read_flag_or(table, "own_outputs", options.own_outputs);
  options.measured_disturbances = read_flag_or(table, "measured_disturbances", options.measured_disturbances);
  options.correct_for_parameters =
      read_flag_or(table, "correct_for_parameters", options.correct_for_parameters);
  options.noise = read_choice_or<SunNoise>(
      table, "noise",
      {{"integrated", SunNoise::integrated}, {"benchmark", SunNoise::benchmark}, {"white", SunNoise::white}},
      options.noise);
  options.noise_filter = read_number_or(table, "noise_filter", {.low = 0, .high = 1, .low_included = true},
                                        options.noise_filter);
  options.noise_order = read_int_or(table, "noise_order", 0, kMaxOrder, options.noise_order);
  return options;
}

void read_badwe2009_models(const TomlTable& table, Badwe2009Options& options) {
  options.filter = read_choice_or<NoiseFilter>(table, "filter",
                                               {{"automatic", NoiseFilter::automatic},
                                                {"none", NoiseFilter::none},
                                                {"moving-average", NoiseFilter::moving_average},
                                                {"first-order", NoiseFilter::first_order},
                                                {"external", NoiseFilter::external}},
                                               options.filter);
  options.filter_length = read_int_or(table, "filter_length", 1, kMaxLength, options.filter_length);
  options.model = read_choice_or<DecorrelationModel>(
      table, "model", {{"fir", DecorrelationModel::fir}, {"output-error", DecorrelationModel::output_error}},
      options.model);
  options.nb = read_int_or(table, "nb", 1, kMaxLength, options.nb);
  options.nf = read_int_or(table, "nf", 0, kMaxLength, options.nf);
  options.fir_length = read_int_or(table, "fir_length", 1, kMaxLength, options.fir_length);
  options.fir_pole =
      read_number_or(table, "fir_pole", {.low = 0, .high = 1, .low_included = true}, options.fir_pole);
}

void read_badwe2009_verdict(const TomlTable& table, Badwe2009Options& options) {
  const NumberRule share{.low = 0, .high = 1, .low_included = true, .high_included = true};
  options.min_lag = read_int_or(table, "min_lag", 0, kMaxLength, options.min_lag);
  options.max_lag =
      read_int_or(table, "max_lag", options.min_lag, kMaxLength, std::max(options.min_lag, options.max_lag));
  options.confidence = read_number_or(table, "confidence", NumberRule::inside(0, 1), options.confidence);
  options.multiplicity = read_choice_or<Multiplicity>(
      table, "multiplicity",
      {{"none", Multiplicity::none}, {"lags", Multiplicity::lags}, {"channels", Multiplicity::channels}},
      options.multiplicity);
  options.weakest_correlation =
      read_number_or(table, "weakest_correlation", share, options.weakest_correlation);
  options.saturated_share = read_number_or(table, "saturated_share", share, options.saturated_share);
  options.smallest_deviation =
      read_number_or(table, "smallest_deviation", NumberRule::at_least(0), options.smallest_deviation);
  options.smallest_own_share = read_number_or(table, "smallest_own_share", share, options.smallest_own_share);
}

Badwe2009Options read_badwe2009(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("badwe2009", study_file_keys("assessment.badwe2009"));
  Badwe2009Options options;
  read_badwe2009_models(table, options);
  read_badwe2009_verdict(table, options);
  return options;
}

Badwe2010Options read_badwe2010(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("badwe2010", study_file_keys("assessment.badwe2010"));
  Badwe2010Options options;
  options.smallest_order = read_int_or(table, "smallest_order", 1, kMaxOrder, options.smallest_order);
  options.largest_order = read_int_or(table, "largest_order", options.smallest_order, kMaxOrder,
                                      std::max(options.smallest_order, options.largest_order));
  options.criterion =
      read_choice_or<DesignedOrderCriterion>(table, "criterion",
                                             {{"record-fit", DesignedOrderCriterion::record_fit},
                                              {"validation-fit", DesignedOrderCriterion::validation_fit},
                                              {"bic", DesignedOrderCriterion::bic}},
                                             options.criterion);
  options.max_iterations = read_int_or(table, "max_iterations", 1, kMaxIterations, options.max_iterations);
  return options;
}

YuQinOptions read_yu_qin(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("yu-qin", study_file_keys("assessment.yu-qin"));
  YuQinOptions options;
  options.confidence = read_number_or(table, "confidence", NumberRule::inside(0, 1), options.confidence);
  options.largest_lag = read_int_or(table, "largest_lag", 0, kMaxLag, options.largest_lag);
  options.first_sample = read_int_or(table, "first_sample", 0, kMaxLag, options.first_sample);
  return options;
}

SseOptions read_sse(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("sse", study_file_keys("assessment.sse"));
  SseOptions options;
  options.threshold = read_number_or(table, "threshold", NumberRule::positive(), options.threshold);
  return options;
}

CounterfactualOptions read_counterfactual(const TomlTable& assessment) {
  const TomlTable table =
      assessment.table_or_empty("counterfactual", study_file_keys("assessment.counterfactual"));
  CounterfactualOptions options;
  options.noise = read_choice_or<NoiseVariance>(table, "noise",
                                                {{"difference", NoiseVariance::difference},
                                                 {"positive", NoiseVariance::positive},
                                                 {"none", NoiseVariance::none}},
                                                options.noise);
  return options;
}

ErrorRegressionOptions read_error_regression(const TomlTable& table) {
  ErrorRegressionOptions options;
  options.alpha = read_number_or(table, "alpha", NumberRule::inside(0, 1), options.alpha);
  options.filters = read_int_or(table, "filters", 1, kMaxOrder, options.filters);
  options.pole = read_number_or(table, "pole", {.low = 0, .high = 1, .low_included = true}, options.pole);
  options.largest_order = read_int_or(table, "largest_order", 0, kMaxOrder, options.largest_order);
  return options;
}

OrderOptions read_order(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("order", study_file_keys("assessment.order"));
  OrderOptions options;
  options.regression = read_error_regression(table);
  options.disturbances = read_flag_or(table, "disturbances", options.disturbances);
  return options;
}

ExcitationOptions read_excitation(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("excitation", study_file_keys("assessment.excitation"));
  ExcitationOptions options;
  options.regression = read_error_regression(table);
  options.measure = read_choice_or<DependenceMeasure>(
      table, "measure",
      {{"f", DependenceMeasure::f}, {"mutual-information", DependenceMeasure::mutual_information}},
      options.measure);
  options.bins = read_int_or(table, "bins", 2, kMaxOrder, options.bins);
  return options;
}

LikelihoodOptions read_likelihood(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("likelihood", study_file_keys("assessment.likelihood"));
  LikelihoodOptions options;
  options.priors = read_choice_or<FaultPriors>(
      table, "priors", {{"wide", FaultPriors::wide}, {"study", FaultPriors::study}}, options.priors);
  const NumberRule probability = NumberRule::inside(0, 1);
  options.fault_probability =
      read_number_or(table, "fault_probability", probability, options.fault_probability);
  options.flag_probability = read_number_or(table, "flag_probability", probability, options.flag_probability);
  options.source_probability = read_number_or(
      table, "source_probability", {.low = 0, .high = 1, .low_included = true}, options.source_probability);
  return options;
}

PmrOptions read_pmr(const TomlTable& assessment) {
  const TomlTable table = assessment.table_or_empty("pmr", study_file_keys("assessment.pmr"));
  PmrOptions options;
  options.alpha = read_number_or(table, "alpha", NumberRule::inside(0, 1), options.alpha);
  options.instruments = read_choice_or<RatioInstruments>(
      table, "instruments",
      {{"outside", RatioInstruments::outside}, {"setpoints", RatioInstruments::setpoints}},
      options.instruments);
  options.filters = read_int_or(table, "filters", 1, kMaxOrder, options.filters);
  options.pole = read_number_or(table, "pole", {.low = 0, .high = 1, .low_included = true}, options.pole);
  return options;
}

AutocovarianceOptions read_autocovariance(const TomlTable& assessment) {
  const TomlTable table =
      assessment.table_or_empty("autocovariance", study_file_keys("assessment.autocovariance"));
  AutocovarianceOptions options;
  options.alpha = read_number_or(table, "alpha", NumberRule::inside(0, 1), options.alpha);
  options.largest_lag = read_int_or(table, "largest_lag", 0, kMaxLength, options.largest_lag);
  options.unexplained = read_choice_or<UnexplainedLoop>(
      table, "unexplained",
      {{"disturbance", UnexplainedLoop::disturbance}, {"mismatch", UnexplainedLoop::mismatch}},
      options.unexplained);
  return options;
}

}  // namespace

std::vector<std::string> read_methods(const TomlTable& document) {
  const TomlTable table = document.table_or_empty("methods", study_file_keys("methods"));
  return read_texts_or(table, "names", "names of methods of assessment, or \"all\" alone", {"botelho"});
}

AssessmentOptions read_assessment(const TomlTable& document) {
  const TomlTable table = document.table_or_empty("assessment", study_file_keys("assessment"));
  AssessmentOptions options;
  options.setpoints = read_choice_or<AssessmentSetpoints>(
      table, "setpoints",
      {{"controller", AssessmentSetpoints::controller}, {"optimizer", AssessmentSetpoints::optimizer}},
      options.setpoints);
  options.sun = read_sun(table);
  options.badwe2009 = read_badwe2009(table);
  options.badwe2010 = read_badwe2010(table);
  options.yu_qin = read_yu_qin(table);
  options.sse = read_sse(table);
  options.counterfactual = read_counterfactual(table);
  options.order = read_order(table);
  options.excitation = read_excitation(table);
  options.candidates.regression =
      read_error_regression(table.table_or_empty("candidates", study_file_keys("assessment.candidates")));
  options.likelihood = read_likelihood(table);
  options.pmr = read_pmr(table);
  options.autocovariance = read_autocovariance(table);
  return options;
}

}  // namespace mpm
