#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/study/study.hpp"
#include "scenarios/toml/number_rule.hpp"
#include "scenarios/toml/toml_table.hpp"

// The parts of the reader of study files, one source file each. `document` is the whole study file. All
// refuse what they cannot take as TomlTable does.

namespace mpm {

/// The whole study file (study_file.cpp); see parse_study(). `draft`, whose keys are study_file_keys(""),
/// takes the values in force; null: they are not recorded.
Study read_study(std::string_view text, const std::string& file_name, TomlDraft* draft);

/// [plant]: a plant of the catalogue, or one that the file defines (study_file_plant.cpp).
PlantModel read_plant(const TomlTable& document);

/// The keys of [plant] that say how equations of ours are integrated (OdeOptions).
inline constexpr std::array kIntegrationKeys{"integrator", "relative_tolerance", "absolute_tolerance",
                                             "step_limit"};

/// How the plant of [plant], whose model is `model`, is simulated; none: by this model
/// (study_file_nonlinear.cpp, as the next two). `folder` is that of the study file.
std::optional<NonlinearSimulation> read_nonlinear_simulation(const TomlTable& document,
                                                             const PlantModel& model,
                                                             const std::filesystem::path& folder);

/// The plant that [plant.fmu] or [plant.program] of the table `plant` describes (study_file_foreign.cpp).
NonlinearModel read_foreign_plant(const TomlTable& plant, const PlantModel& model,
                                  const std::filesystem::path& folder);

/// The list `parameter` of a scenario: parameters of the nonlinear plant of `study` that differ.
std::vector<ParameterChange> read_parameter_changes(const TomlTable& scenario, const Study& study);

/// The place of the inner input of the nonlinear plant of `study` that the key `input` of a disturbance
/// names.
Eigen::Index read_inner_input(const TomlTable& disturbance, const Study& study);

/// [controller] (study_file_controller.cpp).
MpcOptions read_controller(const TomlTable& document, const PlantModel& plant);

/// [controller.program]; none without the table.
std::optional<ControllerProgram> read_controller_program(const TomlTable& document);

/// The setpoints at the start, of [controller.cv.NAME]; ny numbers, 0 for a CV without a setpoint.
Eigen::VectorXd read_initial_setpoints(const TomlTable& document, const PlantModel& plant,
                                       const MpcOptions& controller);

/// [simulation] (study_file_simulation.cpp). The steps are returned in the order of their samples.
SimulationOptions read_simulation(const TomlTable& document, const PlantModel& plant,
                                  const MpcOptions& controller);

/// [record]; `study` has its plant and its simulation (study_file_record.cpp).
RecordOptions read_record(const TomlTable& document, const Study& study);

/// The transfer function in the keys gain, time_constant, numerator, denominator and dead_time of a table
/// (study_file_plant.cpp), as the next two.
TransferFunction read_transfer_function(const TomlTable& table);

/// Refuses a channel of a plant that is not stable: the targets of (6.19) need static gains, y_sim = G0 u of
/// (6.4) runs away for an unstable model, and a plant starts in a steady state.
void refuse_unstable(const TomlTable& table, const TransferFunction& channel);

/// Refuses a model of a disturbance that grows by itself: poles may lie at 0, but not to the right of it.
void refuse_growing(const TomlTable& table, const TransferFunction& Gd);

/// Longest dead time that a study may have, in samples: a bound on the memory that a mistake can cost.
inline constexpr double kMaxDeadTimeSamples = 10000;

/// [[scenario]] (study_file_scenarios.cpp); none when the study draws its experiments at random.
std::vector<Scenario> read_scenarios(const TomlTable& document, const Study& study);

/// [experiments] (study_file_draws.cpp), as the next three. None in a study of named scenarios.
ExperimentCounts read_experiments(const TomlTable& document);

/// [mismatch]; `study` has its plant and its experiments.
MismatchRanges read_mismatch(const TomlTable& document, const Study& study);

/// The list `plant_parameter` of [mismatch] (study_file_nonlinear.cpp).
std::vector<PlantParameterRange> read_plant_parameters(const TomlTable& mismatch, const Study& study);

/// [disturbance]
DisturbanceRanges read_disturbance(const TomlTable& document);

/// [other] (study_file_other.cpp), as the next one; `study` has its plant, controller, simulation and
/// experiments.
OtherRanges read_other(const TomlTable& document, const Study& study);

/// [onset]
OnsetRanges read_onset(const TomlTable& document, const Study& study);

/// A table of weights: all of the names, or none of them, in which case `weights` stay as they are. Names
/// after the first `required` may be left out and have then the weight 0.
void read_weights(const TomlTable& table, std::span<const std::string_view> names, std::size_t required,
                  std::span<double> weights);

/// Refuses a table of weights that are all 0.
void refuse_no_weight(const TomlTable& table, std::span<const double> weights);

/// The size of an effect (FaultScales) under `key`; none without the key.
std::optional<Distribution> read_impact(const TomlTable& table);

/// The key `sequence` of a table of signals.
SignalSequence read_sequence_or(const TomlTable& table, SignalSequence otherwise);

/// [tuning]; `study` has its controller and its experiments.
TuningRanges read_tuning(const TomlTable& document, const Study& study);

/// [sensitivity] (study_file_analysis.cpp), as the next two.
SensitivityOptions read_sensitivity(const TomlTable& document, const PlantModel& plant,
                                    const MpcOptions& controller);

/// [s0_perturbation] (study_file_s0_perturbation.cpp)
S0PerturbationOptions read_s0_perturbation(const TomlTable& document, const PlantModel& plant,
                                           const MpcOptions& controller);

/// [diagnosis]
DiagnosisOptions read_diagnosis(const TomlTable& document);

/// [methods], [assessment] (study_file_assessment.cpp)
std::vector<std::string> read_methods(const TomlTable& document);
AssessmentOptions read_assessment(const TomlTable& document);

/// [monitoring]; none without the table. `study` has its simulation and its scenarios.
std::optional<MonitoringOptions> read_monitoring(const TomlTable& document, const Study& study);

/// [calibration] (study_file_calibration.cpp); none without the table. `study` has its seed and its
/// scenarios.
std::optional<CalibrationOptions> read_calibration(const TomlTable& document, const Study& study);

/// [aggregate]
AggregateOptions read_aggregate(const TomlTable& document);

/// "none", "hold" or "linear" under `key` (study_file_record.cpp).
GapFill read_gap_fill_or(const TomlTable& table, std::string_view key, GapFill fallback);

/// [data] (study_file_data.cpp); `study` has its plant.
DataOptions read_data(const TomlTable& document, const Study& study);

/// [reference]
std::vector<ReportedValue> read_reported(const TomlTable& document);

/// A distribution written as an inline table with one key, such as {uniform = [0.3, 1.5]}, whose every draw
/// satisfies `rule` (study_file_distribution.cpp).
Distribution read_distribution(const TomlTable& table, std::string_view key, const NumberRule& rule);
Distribution read_distribution_or(const TomlTable& table, std::string_view key, const NumberRule& rule,
                                  const Distribution& fallback);

/// The names of variables, in their order.
std::vector<std::string> variable_names(const std::vector<PlantModel::Variable>& variables);

}  // namespace mpm
