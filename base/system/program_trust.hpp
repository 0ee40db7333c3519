#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

// The outside programs that this process may start: only those that the user has named in a file. A study
// that is read from an archive or from the part of a campaign may name programs of others, and opening such a
// file must start nothing.

namespace mpm {

/// A program was to be started without permission. This is not an InputError, so that no loop counts it as
/// its outcome: it ends the command.
class UntrustedProgram : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Allows this process to start this command line, or to load this FMU, from now on.
void trust_program(const std::vector<std::string>& command);
void trust_fmu(const std::filesystem::path& file);
/// Allows everything from now on: the user has asked for it (--trust-programs).
void trust_every_program();

/// Throws UntrustedProgram, with the command line or the path, unless the program or FMU is allowed.
void require_trusted_program(const std::vector<std::string>& command);
void require_trusted_fmu(const std::filesystem::path& file);

}  // namespace mpm
