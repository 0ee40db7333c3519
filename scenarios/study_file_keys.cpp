#include "scenarios/study_file_keys.hpp"

#include <algorithm>
#include <cassert>

namespace mpm {

const std::vector<StudyFileTable>& study_file_tables() {
  static const std::vector<StudyFileTable> tables{
      {"", {"study",       "plant",           "controller",  "simulation", "record",     "experiments",
            "scenario",    "mismatch",        "disturbance", "tuning",     "other",      "onset",
            "sensitivity", "s0_perturbation", "diagnosis",   "methods",    "assessment", "monitoring",
            "calibration", "aggregate",       "reference"}},
      {"study", {"name", "title", "seed"}},
      {"plant",
       {"catalogue", "simulated", "relative_tolerance", "absolute_tolerance", "step_limit", "name", "title",
        "time_unit", "cv", "mv", "md", "channel"}},
      {"plant.cv[]", {"name", "unit", "description"}},
      {"plant.mv[]", {"name", "unit", "description"}},
      {"plant.md[]", {"name", "unit", "description"}},
      {"plant.channel[]", {"cv", "input", "gain", "time_constant", "numerator", "denominator", "dead_time"}},
      {"controller",
       {"sample_time", "prediction_horizon", "control_horizon", "weight_convention", "slack",
        "target_violation_cost", "mv", "cv"}},
      {"controller.mv.NAME", {"cost", "move_suppression", "target_weight", "hard"}},
      {"controller.cv.NAME", {"setpoint_weight", "setpoint", "slack_weight", "soft", "hard"}},
      {"simulation",
       {"samples", "noise_standard_deviation", "noise", "excitation", "step", "random_steps", "limit_step",
        "md_noise", "dither"}},
      {"simulation.noise", {"distribution", "autocorrelation", "factor"}},
      {"simulation.step[]", {"md", "cv", "sample", "level"}},
      {"simulation.random_steps", {"interval", "level"}},
      {"simulation.limit_step[]", {"cv", "sample", "soft"}},
      {"simulation.md_noise", {"standard_deviation", "time_constant"}},
      {"simulation.dither[]", {"mv", "amplitude", "hold"}},
      {"record", {"outliers", "quantisation", "missing", "compression", "candidates"}},
      {"record.outliers", {"share", "size"}},
      {"record.missing", {"share", "length", "fill"}},
      {"record.candidates", {"count", "share"}},
      {"experiments", {"mpm", "ud", "mpm_ud", "healthy", "tuning", "other"}},
      {"scenario[]", {"name", "description", "mismatch", "parameter", "disturbance", "affected"}},
      {"scenario[].mismatch[]",
       {"cv", "input", "gain_factor", "time_constant_factor", "dead_time_shift", "gain", "time_constant",
        "numerator", "denominator", "dead_time"}},
      {"scenario[].parameter[]", {"name", "value", "factor"}},
      {"scenario[].disturbance[]",
       {"cv", "input", "gain", "time_constant", "numerator", "denominator", "dead_time", "white", "hold",
        "sine", "ramp", "steps"}},
      {"scenario[].disturbance[].sine", {"amplitude", "period"}},
      {"scenario[].disturbance[].ramp", {"slope", "start"}},
      {"scenario[].disturbance[].steps[]", {"sample", "level"}},
      {"mismatch",
       {"parameter_weights", "extent_weights", "gain_factor", "time_constant_factor", "dead_time_shift",
        "second_order", "inverse_response", "impact", "plant_parameter"}},
      {"mismatch.parameter_weights",
       {"gain", "time_constant", "dead_time", "second_order", "inverse_response", "sign"}},
      {"mismatch.extent_weights", {"parameter", "channel", "cv", "mv"}},
      {"mismatch.plant_parameter[]", {"name", "factor", "affected"}},
      {"disturbance",
       {"gain", "time_constant", "v_standard_deviation", "signal_weights", "place_weights", "impact"}},
      {"disturbance.signal_weights", {"white", "step", "ramp", "random_walk", "sine", "burst"}},
      {"disturbance.place_weights", {"cv", "mv", "several"}},
      {"other", {"weights", "sensor", "valve", "jump", "md_gain", "md_noise", "limit", "impact"}},
      {"other.weights",
       {"sensor_bias", "sensor_drift", "stiction", "deadband", "md_gain", "md_noise", "limit", "held_mv"}},
      {"onset", {"sample", "growth"}},
      {"tuning", {"parameter_weights", "factor", "sensitivity"}},
      {"tuning.parameter_weights", {"move_suppression", "target_weight", "slack_weight", "setpoint_weight"}},
      {"sensitivity",
       {"form", "samples", "step_size", "step_direction", "active_cvs", "fixed_mvs", "structure",
        "switching"}},
      {"s0_perturbation", {"multipliers", "cvs", "tolerance", "fixed_mvs", "fixed_active_cvs"}},
      {"diagnosis",
       {"impact_band", "variance_centre", "location_distance", "mpm_threshold", "windows", "window_stride",
        "source_population", "self_check", "self_check_band"}},
      {"methods", {"names"}},
      {"assessment",
       {"setpoints", "sun", "badwe2009", "badwe2010", "yu-qin", "sse", "order", "excitation", "candidates"}},
      {"assessment.sun",
       {"tolerance", "index", "orders", "setpoint_order", "criterion", "own_outputs", "measured_disturbances",
        "correct_for_parameters", "noise", "noise_filter", "noise_order"}},
      {"assessment.badwe2009",
       {"filter", "filter_length", "model", "nb", "nf", "fir_length", "fir_pole", "min_lag", "max_lag",
        "confidence", "multiplicity", "weakest_correlation", "saturated_share", "smallest_deviation",
        "smallest_own_share"}},
      {"assessment.badwe2010", {"smallest_order", "largest_order", "criterion", "max_iterations"}},
      {"assessment.yu-qin", {"confidence", "largest_lag", "first_sample"}},
      {"assessment.sse", {"threshold"}},
      {"assessment.order", {"alpha", "filters", "pole", "largest_order", "disturbances"}},
      {"assessment.excitation", {"alpha", "filters", "pole", "largest_order", "measure", "bins"}},
      {"assessment.candidates", {"alpha", "filters", "pole", "largest_order"}},
      {"monitoring", {"window", "stride"}},
      {"calibration", {"false_alarms", "healthy", "ud", "seed"}},
      {"aggregate", {"confidence", "bootstrap_replications"}},
      {"reference", {"FINDING"}},
      {"DISTRIBUTION", {"constant", "uniform", "log_uniform", "normal"}},
  };
  return tables;
}

const std::vector<std::string>& study_file_keys(std::string_view table) {
  const std::vector<StudyFileTable>& tables = study_file_tables();
  const auto found = std::find_if(tables.begin(), tables.end(),
                                  [table](const StudyFileTable& entry) { return entry.name == table; });
  assert(found != tables.end());
  return found->keys;
}

}  // namespace mpm
