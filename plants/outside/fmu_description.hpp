#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "plants/outside/fmi2.hpp"

namespace mpm {

/// Version of the interface of an FMU.
enum class FmiVersion { two, three };

/// Who integrates: the FMU, or mpmbench.
enum class FmuKind { co_simulation, model_exchange };

/// A variable as modelDescription.xml declares it.
struct FmuVariable {
  fmi2::ValueReference reference = 0;
  std::string type;         ///< "Real", "Integer", ...; by FMI 3.0 "Float64", "Int32", ...
  std::string causality;    ///< "input", "output", "parameter", "local", ...
  std::string variability;  ///< "fixed", "tunable", "continuous", ...
};

/// The use of a variable in a study.
enum class FmuRole {
  input,      ///< of causality input
  output,     ///< of causality output or local: any result may be a measurement
  parameter,  ///< of causality parameter
};

/// modelDescription.xml of an FMU (FMI 2.0, 2.2, 3.3 and 4.3; FMI 3.0, chapters 2 to 4).
struct FmuDescription {
  std::string file;  ///< of the FMU, for messages
  FmiVersion version = FmiVersion::two;
  FmuKind kind = FmuKind::co_simulation;  ///< co-simulation if the FMU can be both
  std::string guid;        ///< the library compares it with its own; by FMI 3.0 the instantiation token
  std::string identifier;  ///< name of the library
  std::size_t states = 0, indicators = 0;  ///< for model exchange; by FMI 3.0 the library reports them
  std::map<std::string, FmuVariable, std::less<>> variables;

  /// Returns the variable of this name. Errors: InputError at `place`, which lists names of that role, if the
  /// variable is not there, has another causality or is no real number.
  const FmuVariable& variable(std::string_view name, FmuRole role, const std::string& place) const;
};

/// Reads the text of modelDescription.xml. Errors: InputError that begins with `file` if the text is no XML,
/// has another FMI version, is for neither co-simulation nor model exchange, or lacks an attribute.
FmuDescription parse_fmu_description(const std::string& xml, const std::string& file);

}  // namespace mpm
