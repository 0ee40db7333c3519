#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/study/study.hpp"
#include "scenarios/toml/option_keys.hpp"
#include "scenarios/toml/toml_draft.hpp"
#include "scenarios/toml/toml_table.hpp"

// The keys of the study file, with one source file for each group of tables. They are read into `study` in
// the order of the top level and may depend on values that were read before. All refuse wrong values as
// TomlTable does.

namespace mpm {

/// Reads the whole study file (study_file.cpp); see parse_study(). The values in force are recorded in
/// `draft`, whose keys are those of the top level; if it is null, they are not recorded.
Study read_study(std::string_view text, const std::string& file_name,
                 std::shared_ptr<const MethodTable> methods, TomlDraft* draft);

/// Returns the values of resolved_study() with their defaults (resolved_study.cpp).
std::vector<TomlDraft::Line> resolved_lines(const Study& study);

/// [plant] (study_file_plant.cpp). `folder` is that of the study file.
OptionKey plant_key(Study& study, const std::filesystem::path& folder);

/// The keys of [plant] for the simulation of a plant of the catalogue (study_file_nonlinear.cpp).
OptionKeys simulated_keys();

/// Reads how the plant of [plant], whose model is `model`, is simulated. Returns none if it is simulated by
/// this model.
std::optional<NonlinearSimulation> read_nonlinear_simulation(const TomlTable& plant, const PlantModel& model,
                                                             const std::filesystem::path& folder);

/// The keys `fmu` and `program` of [plant] (study_file_foreign.cpp).
OptionKeys foreign_keys();

/// Reads the plant that [plant.fmu] or [plant.program] of the table `plant` describes.
NonlinearModel read_foreign_plant(const TomlTable& plant, const PlantModel& model,
                                  const std::filesystem::path& folder);

/// The list `parameter` of a scenario: changed parameters of the nonlinear plant of `study`.
OptionKey parameter_changes_key(std::vector<ParameterChange>& changes, const Study& study);

/// The list `plant_parameter` of [mismatch].
OptionKey plant_parameters_key(std::vector<PlantParameterRange>& ranges, const Study& study);

/// Returns the place of the inner input of the nonlinear plant of `study` that the key `input` of a
/// disturbance names.
Eigen::Index read_inner_input(const TomlTable& disturbance, const Study& study);

/// [controller], with the setpoints at the start (study_file_controller.cpp).
OptionKey controller_key(Study& study);

/// Returns whether a finite limit of the soft range lies outside the hard range, where it could never be
/// reached.
bool lies_outside(const NumberPair& soft, const NumberPair& hard);

/// [simulation] (study_file_simulation.cpp). The steps are in the order of their samples.
OptionKey simulation_key(Study& study);

/// [record] (study_file_record.cpp)
OptionKey record_key(Study& study);

/// The key `fill`.
OptionKey fill_key(GapFill& fill, std::string meaning);

/// [world] (study_file_world.cpp)
OptionKey world_key(Study& study);

/// [[scenario]] (study_file_scenarios.cpp)
OptionKey scenarios_key(Study& study);

/// [experiments] (study_file_draws.cpp)
OptionKey experiments_key(Study& study);

/// [mismatch], [disturbance], [tuning], [other], [onset]
OptionKeys fault_keys(Study& study);

/// The key `sequence` of a table of signals.
OptionKey sequence_key(SignalSequence& sequence, std::string meaning);

/// [sensitivity], [s0_perturbation], [diagnosis] (study_file_analysis.cpp)
OptionKeys analysis_keys(Study& study);

/// [aggregate], [reference]
OptionKey aggregate_key(Study& study);
OptionKey reference_key(Study& study);

/// [methods], [assessment], [monitoring], [calibration] (study_file_assessment.cpp)
OptionKeys method_keys(Study& study);

/// [data] (study_file_data.cpp)
OptionKey data_key(Study& study);

}  // namespace mpm
