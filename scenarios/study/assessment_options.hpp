#pragma once

#include <cstdint>
#include <vector>

#include "scenarios/study/badwe2009_options.hpp"

// The open choices of the methods that assess a controller ([assessment] of a study file). One structure a
// method; the chain of the thesis has its own, DiagnosisOptions.

namespace mpm {

/// What stands for the setpoint of a CV that the controller holds in a range.
enum class AssessmentSetpoints : std::int8_t {
  controller = 0,  ///< nothing: a method that needs setpoints does not apply
  optimizer = 1,   ///< the steady state that the target optimizer computes (2.32), as chapter 2 does it
};

/// The model of the disturbances with which one step is predicted (2.2).
enum class SunNoise : std::int8_t {
  integrated = 0,  ///< (1 - c q^-1)/(1 - q^-1): integrated noise seen through white noise
  benchmark = 1,   ///< an autoregression identified in the benchmark
  white = 2,       ///< 1: the simulation errors are the prediction errors
};

/// By what one of several orders of the ARX model is chosen.
enum class SunCriterion : std::int8_t { aic = 0, bic = 1, validation = 2 };

/// Which index of a CV is held against the tolerance.
enum class SunIndex : std::int8_t {
  imqi = 0,  ///< (4.3), with the root
  mqi = 1,   ///< (2.4) of that CV alone, without it: the square
};

/// Of the method of Sun et al. (2013), analysis/methods/sun_method.
struct SunOptions {
  double tolerance = 0.85;  ///< MQI and iMQI below it show a poor model (2.4.2)
  SunIndex index = SunIndex::imqi;
  std::vector<int> orders{20};  ///< MO1 of (2.1); of several one is chosen for each CV
  int setpoint_order = 0;       ///< MO2 of (2.1); 0: as MO1
  SunCriterion criterion = SunCriterion::aic;
  bool own_outputs = false;             ///< AO of (2.1) is diagonal
  bool measured_disturbances = false;   ///< they stand beside the setpoints in (2.1)
  bool correct_for_parameters = false;  ///< sums of squares of e^d over n - p in place of n
  SunNoise noise = SunNoise::integrated;
  double noise_filter = 0.7;  ///< c of `integrated`
  int noise_order = 10;       ///< highest order of `benchmark`

  bool operator==(const SunOptions&) const = default;
};

/// By what the order of an output-error model of Badwe et al. (2010) is chosen.
enum class DesignedOrderCriterion : std::int8_t {
  record_fit = 0,      ///< largest %Fit (3.32) over the record that the models are fitted to
  validation_fit = 1,  ///< largest %Fit over the end of the record, of models fitted to what is before it;
                       ///< the order chosen is then fitted to the whole record
  bic = 2,             ///< smallest n log V + p log n over the record
};

/// Of the method of Badwe et al. (2010), analysis/methods/badwe2010_method.
struct Badwe2010Options {
  int smallest_order = 3, largest_order = 7;  ///< of the output-error models (3.3.2)
  DesignedOrderCriterion criterion = DesignedOrderCriterion::record_fit;
  int max_iterations = 20;  ///< of the search for each model

  bool operator==(const Badwe2010Options&) const = default;
};

/// Of the method of Yu and Qin (2008), analysis/methods/yu_qin_method.
struct YuQinOptions {
  double confidence = 0.95;  ///< of the limits of eigenvalues and angles
  int largest_lag = 0;       ///< of the sum over autocorrelations (2.9); 0: all lags
  int first_sample = 0;      ///< at which both periods begin; leaves out how a loop starts

  bool operator==(const YuQinOptions&) const = default;
};

/// Of a monitor of the simulation errors alone, analysis/methods/sse_method.
struct SseOptions {
  double threshold =
      1.5;  ///< a CV is flagged when its mean squared error is above so many times the benchmark's

  bool operator==(const SseOptions&) const = default;
};

/// What noise adds to the variance of a CV, of the method `counterfactual`: v of Ivar = var y / (var y0 + v).
/// With var y_b that of the benchmark and var y0_b that of the same loop simulated without noise,
enum class NoiseVariance : std::int8_t {
  difference = 0,  ///< v = var y_b - var y0_b, which may be negative: noise also keeps CVs off their limits
  positive = 1,    ///< v = max(0, var y_b - var y0_b): noise that adds to the variance or does nothing
  none = 2,        ///< v = 0
};

/// Of the method `counterfactual`, analysis/methods/counterfactual_method.
struct CounterfactualOptions {
  NoiseVariance noise = NoiseVariance::difference;

  bool operator==(const CounterfactualOptions&) const = default;
};

/// Of the methods that regress the simulation errors on other signals (analysis/methods/error_regression).
struct ErrorRegressionOptions {
  double alpha = 0.01;     ///< share of loops in which nothing is to be found that are flagged at most
  int filters = 4;         ///< Laguerre filters a signal
  double pole = 0.8;       ///< of these filters
  int largest_order = 12;  ///< of the autoregression of an error

  bool operator==(const ErrorRegressionOptions&) const = default;
};

/// Of the method `order`, analysis/methods/order_method.
struct OrderOptions {
  ErrorRegressionOptions regression;
  bool disturbances = true;  ///< an error that is coloured in another way than in the benchmark is flagged

  bool operator==(const OrderOptions&) const = default;
};

/// How the method `excitation` measures that two signals depend on each other.
enum class DependenceMeasure : std::int8_t {
  f = 0,                   ///< F test of a linear regression
  mutual_information = 1,  ///< mutual information of binned signals
};

/// Of the method `excitation`, analysis/methods/excitation_method.
struct ExcitationOptions {
  ErrorRegressionOptions regression;
  DependenceMeasure measure = DependenceMeasure::f;
  int bins = 4;  ///< a signal, of the mutual information

  bool operator==(const ExcitationOptions&) const = default;
};

/// Of the method `candidates`, analysis/methods/candidates_method.
struct CandidatesOptions {
  ErrorRegressionOptions regression;

  bool operator==(const CandidatesOptions&) const = default;
};

/// What the method `likelihood` takes for possible before it sees a record (analysis/methods/fault_priors).
enum class FaultPriors : std::int8_t {
  wide = 0,   ///< whatever a plant may have: one fault or several, of any size
  study = 1,  ///< the faults that the study draws, as often and as large as it draws them
};

/// Of the method `likelihood`, analysis/methods/likelihood_method.
struct LikelihoodOptions {
  FaultPriors priors = FaultPriors::wide;
  double fault_probability = 0.5;  ///< of some fault in a loop, before the record is seen; of wide priors
  double flag_probability = 0.5;   ///< a loop or a CV is flagged when a fault is more probable than this
  /// A source is named when it is at least so probable, given that there is a fault; 0: always.
  double source_probability = 0.0;

  bool operator==(const LikelihoodOptions&) const = default;
};

/// From which signals the method `pmr` takes what is made of a loop from outside.
enum class RatioInstruments : std::int8_t {
  outside = 0,    ///< measured disturbances, setpoints, moving limits and test signals
  setpoints = 1,  ///< setpoints alone, as the paper has them
};

/// Of the plant-model ratio, analysis/methods/pmr_method.
struct PmrOptions {
  double alpha = 0.01;  ///< share of loops without mismatch that are flagged at most
  RatioInstruments instruments = RatioInstruments::outside;
  int filters = 10;   ///< a signal, of the regression of the MVs on the signals from outside; one is direct
  double pole = 0.9;  ///< of these Laguerre filters

  bool operator==(const PmrOptions&) const = default;
};

/// What the method `autocovariance` makes of a loop that no mismatch of one number explains.
enum class UnexplainedLoop : std::int8_t {
  disturbance = 0,  ///< a disturbance: mismatches are what it looks for, and none of them is it
  mismatch = 1,     ///< a mismatch, as the paper has it, in which nothing else can be wrong
};

/// Of the autocovariances of a linear loop, analysis/methods/autocovariance_method.
struct AutocovarianceOptions {
  double alpha = 0.01;   ///< of the tests, over all CVs
  int largest_lag = 32;  ///< samples; the lags are 0, 1, 2, 4, ... up to it
  UnexplainedLoop unexplained = UnexplainedLoop::disturbance;

  bool operator==(const AutocovarianceOptions&) const = default;
};

/// [assessment]
struct AssessmentOptions {
  AssessmentSetpoints setpoints = AssessmentSetpoints::controller;
  SunOptions sun;
  Badwe2009Options badwe2009;
  Badwe2010Options badwe2010;
  YuQinOptions yu_qin;
  SseOptions sse;
  CounterfactualOptions counterfactual;
  OrderOptions order;
  ExcitationOptions excitation;
  CandidatesOptions candidates;
  LikelihoodOptions likelihood;
  PmrOptions pmr;
  AutocovarianceOptions autocovariance;

  bool operator==(const AssessmentOptions&) const = default;
};

}  // namespace mpm
