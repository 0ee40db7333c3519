// [methods], [assessment], [monitoring], [calibration]

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenarios/files/study_file_parts.hpp"
#include "scenarios/study/window_scan.hpp"
#include "scenarios/toml/option_keys.hpp"

namespace mpm {
namespace {

constexpr std::int64_t kMaxOrder = 100;
constexpr std::int64_t kMaxLag = 1'000'000;
constexpr std::int64_t kMaxLength = 1000;  // of filters and lags, in samples
constexpr std::int64_t kMaxIterations = 100'000;
constexpr std::int64_t kMaxCalibrationLoops = 1'000'000;  // of one kind
constexpr std::int64_t kShortestMonitoringWindow = kShortestWindow + kFewestCorrelatedPairs;

/// A number that is at least another one, which is read before it.
OptionKey at_least_key(const char* name, int& value, const int& least, std::int64_t high,
                       const char* meaning) {
  OptionKey made = key::whole(name, value, 0, high, meaning);
  made.reader = [&value, &least, high](const TomlTable& table, const OptionKey& key) {
    value = static_cast<int>(read_whole_or(table, key.name, least, high, std::max(least, value)));
  };
  return made;
}

/// A list of whole numbers.
OptionKey orders_key(std::vector<int>& orders) {
  OptionKey made =
      key::option("orders", "list of whole numbers",
                  "MO1 of (2.1). Of several one is chosen for each CV. Open; 20 is above the dead times of "
                  "all shipped plants and takes 14 % of the degrees of freedom of 900 samples of three CVs")
          .otherwise("`[20]`")
          .allow("1 to 100 each");
  made.reader = [&orders](const TomlTable& table, const OptionKey& key) {
    const NumberRule rule{.low = 1, .high = kMaxOrder, .low_included = true, .high_included = true};
    if (table.has(key.name)) {
      orders.clear();
      for (const double order : read_numbers(table, key.name, rule, kMaxOrder)) {
        if (order != std::floor(order))
          table.refuse(key.name, fmt::format("{}", order), "whole numbers");
        orders.push_back(static_cast<int>(order));
      }
    }
    table.record(key.name, orders);  // as whole numbers
  };
  return made;
}

OptionKeys keys(SunOptions& options) {
  return {
      key::number("tolerance", options.tolerance, NumberRule::positive(),
                  "MQI and iMQI below it show a poor model; the limit of section 2.4.2. Chapter 4 says 0.8"),
      key::choice("index", options.index, {"imqi", "mqi"},
                  "what of a CV is held against it: (4.3), with its root, as in chapter 4, or "
                  "(2.4) of the CV alone, without the root, as in figures 2.15 and 2.16"),
      orders_key(options.orders),
      key::whole("setpoint_order", options.setpoint_order, 0, kMaxOrder,
                 "MO2 of (2.1); 0: as MO1, since nothing is known of the difference"),
      key::choice(
          "criterion", options.criterion, {"aic", "bic", "validation"},
          "by what one of several orders is chosen; validation: mean squared prediction error on the last 30 "
          "%. AIC, because the loop of an offset-free controller is no ARX model of finite order, and the "
          "best predictor is wanted"),
      key::flag("own_outputs", options.own_outputs,
                "the past of the CV alone, in place of that of all CVs. (2.1) has full matrices; for short "
                "records of many CVs"),
      key::flag("measured_disturbances", options.measured_disturbances,
                "they stand beside the setpoints in (2.1), which has setpoints only"),
      key::flag(
          "correct_for_parameters", options.correct_for_parameters,
          "sums of squares of e^d over n - p in place of n, p the coefficients fitted. (2.4) has plain sums"),
      key::choice("noise", options.noise, {"integrated", "benchmark", "white"},
                  "G_d0 of (2.2): the designed filter (1 - c q^-1)/(1 - q^-1), an autoregression "
                  "identified in the benchmark, or 1. Integrated: a controller that holds its "
                  "output error constant assumes it, with c = 0"),
      key::number("noise_filter", options.noise_filter, NumberRule::below_one(),
                  "c. White errors of a perfect model have MQI (1 + c)/2 under this filter: 0.7 is the c "
                  "nearest to the controller's own at which the tolerance 0.85 does not flag them"),
      key::whole("noise_order", options.noise_order, 0, kMaxOrder,
                 "highest order of the autoregression; BIC chooses")};
}

OptionKeys keys(Badwe2009Options& options) {
  return {
      key::choice(
          "filter", options.filter, {"automatic", "none", "moving-average", "first-order", "external"},
          "how noise is taken out first (A1.2). `\"external\"`: of the MVs only what setpoints and measured "
          "disturbances make them do. `\"automatic\"`: that where at least as many of these move as MVs are "
          "evaluated, since fewer cannot tell the MVs apart, and `\"none\"` otherwise"),
      key::whole("filter_length", options.filter_length, 1, kMaxLength,
                 "samples of the moving average; time constant of the first-order filter in samples"),
      key::choice(
          "model", options.model, {"output-error", "fir"},
          "models of (2.5) and (2.6): a regression, which has one answer and costs a hundredth, or the "
          "output-error search of the thesis"),
      key::whole("nb", options.nb, 1, kMaxLength, "order of B of each path of an output-error model"),
      key::whole("nf", options.nf, 0, kMaxLength, "order of F of each path"),
      key::whole("fir_length", options.fir_length, 1, kMaxLength,
                 "Laguerre filters an input, one of them direct"),
      key::number("fir_pole", options.fir_pole, NumberRule::below_one(),
                  "their pole, about exp(-sample time/time constant) of the slow channels; 0 is a finite "
                  "impulse response"),
      key::whole("min_lag", options.min_lag, 0, kMaxLength,
                 "first lag looked at. u(k) acts after y(k), so lag 0 has only the controller's answer to "
                 "the noise of y(k)"),
      at_least_key("max_lag", options.max_lag, options.min_lag, kMaxLength,
                   "last lag: dead time and time constant of the slow channels. A record has at least four "
                   "times as many samples")
          .allow("`min_lag` to 1000"),
      key::number("confidence", options.confidence, NumberRule::inside(0, 1),
                  "confidence of the band of the partial correlation"),
      key::choice(
          "multiplicity", options.multiplicity, {"none", "lags", "channels"},
          "among how many correlations 1 - `confidence` is shared out: one, the lags of a channel, or those "
          "of all channels, so that it is the rate of false alarms of a loop"),
      key::number("weakest_correlation", options.weakest_correlation, NumberRule::share(),
                  "correlations up to it are not strong, however significant; the thesis gives no number"),
      key::number("saturated_share", options.saturated_share, NumberRule::share(),
                  "an MV at a hard limit for more of the record is left out (\"most of the time\", 2.4.2)"),
      key::number("smallest_deviation", options.smallest_deviation, NumberRule::at_least(0),
                  "an MV with a smaller standard deviation is left out"),
      key::number("smallest_own_share", options.smallest_own_share, NumberRule::share(),
                  "an MV of whose variance (2.5) leaves less is left out")};
}

OptionKeys keys(Badwe2010Options& options) {
  return {key::whole("smallest_order", options.smallest_order, 1, kMaxOrder,
                     "smallest order of the output-error models that is tried (3.3.2)"),
          at_least_key("largest_order", options.largest_order, options.smallest_order, kMaxOrder,
                       "largest order n (3.3.2). A record of no more samples than the 2n + 1 coefficients of "
                       "each CV with a setpoint is not assessed")
              .allow("`smallest_order` to 100"),
          key::choice(
              "criterion", options.criterion, {"record-fit", "validation-fit", "bic"},
              "how the order is chosen: the largest %Fit (3.32) over the record, which is the \"best model "
              "fit\" that the thesis reports; the largest over the last 30 % by models of the first 70 %; "
              "the smallest BIC"),
          key::whole("max_iterations", options.max_iterations, 1, kMaxIterations,
                     "iterations of the search for each model; 20 is the default of `oe` in Matlab, with "
                     "which the thesis worked")};
}

OptionKeys keys(YuQinOptions& options) {
  return {
      key::number("confidence", options.confidence, NumberRule::inside(0, 1),
                  "confidence of the limits of eigenvalues and angles (2.4.1)"),
      key::whole("largest_lag", options.largest_lag, 0, kMaxLag,
                 "largest lag of the sum over squared autocorrelations (2.9), samples; 0: all lags, because "
                 "the thesis prints the sum so. It overstates the sum, so that changes are called "
                 "significant too rarely (`docs/methods.md`)"),
      key::whole(
          "first_sample", options.first_sample, 0, kMaxLag,
          "sample at which the compared periods begin. 0: the whole record, as for every other method. A "
          "loop whose plant is not its model starts with a transient, which the variances else are made of")};
}

OptionKeys keys(SseOptions& options) {
  return {key::number(
      "threshold", options.threshold, NumberRule::positive(),
      "a CV is flagged when its mean squared simulation error is above so many times that of the benchmark. "
      "The thesis has no limit; the mean squares of white noise over 400 samples scatter by 0.1 around 1, so "
      "that 1.5 is seldom met by chance and errors of 0.7 standard deviations of the noise are seen")};
}

OptionKeys keys(CounterfactualOptions& options) {
  return {key::choice(
      "noise", options.noise, {"difference", "positive", "none"},
      "v of Ivar = var y / (var y0 + v), what noise adds to the variance: var y - var y0 of the benchmark, "
      "of either sign, since noise also keeps CVs off their limits; the same and not below 0; or 0")};
}

OptionKeys keys(ErrorRegressionOptions& options) {
  return {
      key::number("alpha", options.alpha, NumberRule::inside(0, 1),
                  "a loop in which nothing is to be found is flagged with this probability at most, over all "
                  "its CVs"),
      key::whole("filters", options.filters, 1, kMaxOrder, "Laguerre filters of each signal"),
      key::number(
          "pole", options.pole, NumberRule::below_one(),
          "their pole: what they remember falls by it from sample to sample. 0 is a finite impulse response"),
      key::whole("largest_order", options.largest_order, 0, kMaxOrder,
                 "of the autoregression of a simulation error; BIC chooses")};
}

OptionKeys keys(OrderOptions& options) {
  OptionKeys all = keys(options.regression);
  all.push_back(
      key::flag("disturbances", options.disturbances,
                "a simulation error that is coloured in another way than in the benchmark, or about another "
                "mean, is flagged as a disturbance; false: a monitor of the model alone"));
  return all;
}

OptionKeys keys(ExcitationOptions& options) {
  OptionKeys all = keys(options.regression);
  all.push_back(key::choice(
      "measure", options.measure, {"f", "mutual-information"},
      "what shows that the error follows a signal: the F test of a linear regression, or the mutual "
      "information, which sees what is not linear, too, and needs more of it"));
  all.push_back(
      key::whole("bins", options.bins, 2, kMaxOrder,
                 "of each signal, of the mutual information. A record has 5 samples for each pair of them"));
  return all;
}

OptionKeys keys(CandidatesOptions& options) {
  return keys(options.regression);
}

OptionKeys keys(LikelihoodOptions& options) {
  return {
      key::choice("priors", options.priors, {"wide", "study"},
                  "faults before the record is seen: of any size, on one CV or several, or "
                  "those that the study draws, as often and as large as it draws them. "
                  "`\"wide\"` because nobody knows of a plant what its faults are drawn from"),
      key::number(
          "fault_probability", options.fault_probability, NumberRule::inside(0, 1),
          "of some fault in a loop, before the record is seen; of wide priors. 0.5: nothing is known"),
      key::number("flag_probability", options.flag_probability, NumberRule::inside(0, 1),
                  "a loop, and a CV, is flagged when a fault is more probable than this, given the record. "
                  "0.5: the fewest wrong verdicts when a missed fault costs what a false alarm does"),
      key::number(
          "source_probability", options.source_probability, NumberRule::below_one(),
          "the source of a CV is named when it is at least so probable, given that the CV has a fault. 0: "
          "the most probable one always, since a source that is not named counts as wrong")};
}

OptionKeys keys(PmrOptions& options) {
  return {key::number("alpha", options.alpha, NumberRule::inside(0, 1),
                      "share of loops without mismatch that are flagged at most, shared out to the CVs"),
          key::choice(
              "instruments", options.instruments, {"outside", "setpoints"},
              "signals that no disturbance can know, from which what they make of the MVs is computed: MDs, "
              "setpoints, moving limits and test signals, or the setpoints alone, as the papers have it. "
              "`\"outside\"` because a controller in ranges has no setpoints"),
          key::whole("filters", options.filters, 1, kMaxOrder,
                     "Laguerre filters of each of these signals, one of them direct, in the regression of "
                     "the MVs. More follow the MVs better, and follow a part of the noise in them"),
          key::number("pole", options.pole, NumberRule::below_one(), "of these filters")};
}

OptionKeys keys(AutocovarianceOptions& options) {
  return {
      key::number("alpha", options.alpha, NumberRule::inside(0, 1), "of the tests, over all CVs"),
      key::whole("largest_lag", options.largest_lag, 0, kMaxLength,
                 "samples; the lags are 0, 1, 2, 4, ... up to it. Neighbours say nearly the same, and "
                 "their covariance has hardly an inverse"),
      key::choice("unexplained", options.unexplained, {"disturbance", "mismatch"},
                  "source of a flagged loop that no mismatch of one number explains. `\"mismatch\"` is the "
                  "paper's, in which nothing else can be wrong")};
}

/// The table of a method.
template <class Options>
OptionKey method_table(const char* name, Options& options, const char* meaning) {
  return key::table(
      name, [&options] { return keys(options); }, meaning);
}

OptionKeys assessment_keys(AssessmentOptions& options) {
  return {
      key::choice(
          "setpoints", options.setpoints, {"controller", "optimizer"},
          "what stands for the setpoint of a CV that is held in a range. `\"controller\"`: nothing, and a "
          "method that needs setpoints does not apply; it is the default because a range has none. "
          "`\"optimizer\"`: the steady state that the target optimizer computes (2.32), as chapter 2 of the "
          "thesis does to show what comes of it"),
      method_table("sun", options.sun, "of the method of Sun et al."),
      method_table("badwe2009", options.badwe2009, "of the method of Badwe et al. (2009)"),
      method_table("badwe2010", options.badwe2010, "of the method of Badwe et al. (2010)"),
      method_table("yu-qin", options.yu_qin, "of the method of Yu and Qin"),
      method_table("sse", options.sse, "of the monitor of the simulation errors"),
      method_table("counterfactual", options.counterfactual, "of the simulated nominal loop"),
      method_table("order", options.order, "of the order test from the MVs to the simulation errors"),
      method_table("excitation", options.excitation,
                   "of the test of the simulation errors against signals from outside"),
      method_table("candidates", options.candidates,
                   "of the test of the simulation errors against further logged signals"),
      method_table("likelihood", options.likelihood, "of the posterior of the faults"),
      method_table("pmr", options.pmr, "of the plant-model ratio"),
      method_table("autocovariance", options.autocovariance, "of the autocovariances of a linear loop")};
}

OptionKeys methods_keys(std::vector<std::string>& names) {
  return {key::texts(
              "names", names, "names of methods of assessment, or \"all\" alone",
              "methods of assessment that see every loop of the study (`mpmbench compare --help` lists "
              "them), or `[\"all\"]`. `botelho` is the chain of the thesis. `run --methods A,B` takes others")
              .allow("names of methods, each once")};
}

/// A table that turns on what only a study of random experiments has.
template <class Options>
OptionKey random_part(const char* name, Study& study, std::optional<Options> Study::*part,
                      OptionKeys (*keys)(Options&, const Study&), const char* meaning) {
  const auto below = [keys] {
    const Study no_study;
    Options options;
    return keys(options, no_study);
  };
  const auto read = [&study, part, keys](const TomlTable& document, const std::string& key) {
    Options options;
    const OptionKeys of_part = keys(options, study);
    const TomlTable table = document.table(key, key_names(of_part));
    if (study.names_scenarios())
      table.refuse("", key + " of a study of named scenarios", "only in a study of random experiments");
    read_keys(table, of_part);
    study.*part = options;
  };
  return key::option(name, "table", meaning).with("", below).read(read);
}

OptionKeys monitoring_keys(MonitoringOptions& options, const Study& study) {
  const std::int64_t samples = study.simulation.samples;
  options.window = static_cast<int>(std::min<std::int64_t>(options.window, samples));
  options.stride = static_cast<int>(std::min<std::int64_t>(options.stride, samples));
  return {key::whole(
              "window", options.window, std::min(kShortestMonitoringWindow, samples), samples,
              "samples that a verdict looks back on. Methods that filter or simulate the loop do so from the "
              "start of the record, and judge these samples. A longer window sees smaller faults, later")
              .otherwise("200, or the whole record where it is shorter")
              .allow("24 to `simulation.samples`"),
          key::whole("stride", options.stride, 1, samples, "samples from one verdict to the next")
              .allow("1 to `simulation.samples`")};
}

OptionKeys calibration_keys(CalibrationOptions& options, const Study& study) {
  // Loops of the same seed would be those that the thresholds are tried on.
  const auto read_seed = [&](const TomlTable& table, const std::string& key) {
    options.seed =
        static_cast<std::uint64_t>(read_whole(table, key, 0, std::numeric_limits<std::int64_t>::max()));
    if (*options.seed == study.seed)
      table.refuse(key, fmt::format("{}, the seed of the study", *options.seed), "another one");
  };
  return {key::number("false_alarms", options.false_alarms, NumberRule::inside(0, 1),
                      "share of healthy loops that a calibrated threshold flags at most, of the rate "
                      "`false_alarm_calibrated`; the others are at 1 % and at 5 %"),
          key::whole("healthy", options.healthy, 1, kMaxCalibrationLoops,
                     "loops without a fault. 1 % needs 99, 5 % needs 19; 200 leave the rate at 5 % within "
                     "2.4 and 8.4 %"),
          key::whole("ud", options.ud, 0, kMaxCalibrationLoops,
                     "loops with an unmeasured disturbance alone, for the thresholds of a monitor of the "
                     "model, which is to leave them alone"),
          key::option("seed", "whole number", "seed of these loops")
              .otherwise("that of the study with the bits of 0x63616c6962726174 (\"calibrat\") flipped")
              .allow("not that of the study, nor of `run --seed`")
              .read(read_seed)};
}

}  // namespace

OptionKeys method_keys(Study& study) {
  return {
      key::table(
          "methods", [&study] { return methods_keys(study.methods); }, "which methods assess the loops"),
      key::table(
          "assessment", [&study] { return assessment_keys(study.assessment); },
          "the open choices of the methods of the literature"),
      random_part("monitoring", study, &Study::monitoring, monitoring_keys,
                  "methods on a window that moves over the record: delay of detection, false alarms a day")
          .otherwise("none: methods see whole records only"),
      random_part("calibration", study, &Study::calibration, calibration_keys,
                  "loops of another seed on which the thresholds of the methods are calibrated")
          .otherwise("none: no calibrated thresholds")};
}

}  // namespace mpm
