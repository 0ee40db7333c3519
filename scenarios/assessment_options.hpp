#pragma once

#include <cstdint>

#include "scenarios/badwe2009_options.hpp"

// The open choices of the methods that assess a controller ([assessment] of a study file). One structure a
// method; the chain of the thesis has its own, DiagnosisOptions.

namespace mpm {

/// What stands for the setpoint of a CV that the controller holds in a range.
enum class AssessmentSetpoints : std::int8_t {
  controller = 0,  ///< nothing: a method that needs setpoints does not apply
  optimizer = 1,   ///< the steady state that the target optimizer computes (2.32), as chapter 2 does it
};

/// Of the method of Sun et al. (2013), analysis/assessment/sun.
struct SunOptions {
  double tolerance = 0.85;  ///< MQI and iMQI below it show a poor model (2.4.2)
};

/// By what the order of an output-error model of Badwe et al. (2010) is chosen.
enum class DesignedOrderCriterion : std::int8_t {
  record_fit = 0,      ///< largest %Fit (3.32) over the record that the models are fitted to
  validation_fit = 1,  ///< largest %Fit over the end of the record, of models fitted to what is before it;
                       ///< the order chosen is then fitted to the whole record
  bic = 2,             ///< smallest n log V + p log n over the record
};

/// Of the method of Badwe et al. (2010), analysis/assessment/badwe2010.
struct Badwe2010Options {
  int smallest_order = 3, largest_order = 7;  ///< of the output-error models (3.3.2)
  DesignedOrderCriterion criterion = DesignedOrderCriterion::record_fit;
  int max_iterations = 20;  ///< of the search for each model
};

/// Of the method of Yu and Qin (2008), analysis/assessment/yu_qin.
struct YuQinOptions {
  double confidence = 0.95;  ///< of the limits of eigenvalues and angles
  int largest_lag = 0;       ///< of the sum over autocorrelations (2.9); 0: all lags
  int first_sample = 0;      ///< at which both periods begin; leaves out how a loop starts
};

/// Of a monitor of the simulation errors alone, analysis/assessment/sse_method.
struct SseOptions {
  double threshold =
      1.5;  ///< a CV is flagged when its mean squared error is above so many times the benchmark's
};

/// [assessment]
struct AssessmentOptions {
  AssessmentSetpoints setpoints = AssessmentSetpoints::controller;
  SunOptions sun;
  Badwe2009Options badwe2009;
  Badwe2010Options badwe2010;
  YuQinOptions yu_qin;
  SseOptions sse;
};

}  // namespace mpm
