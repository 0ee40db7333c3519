#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

// Which outside programs this process may start: only those that the user has named in a file. A study that
// is read from an archive or from the part of a campaign may name programs of others, and opening a file must
// start nothing.

namespace mpm {

/// A program was to be started without permission. This is not an InputError, so that no loop counts it as
/// its outcome: it ends the command.
class UntrustedProgram : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// From now on this command line may be started, and this FMU loaded.
void trust_program(const std::vector<std::string>& command);
void trust_fmu(const std::filesystem::path& file);
/// From now on everything may: the user has said so (--trust-programs).
void trust_every_program();

/// Throws UntrustedProgram, which shows the command line or the path.
void require_trusted_program(const std::vector<std::string>& command);
void require_trusted_fmu(const std::filesystem::path& file);

}  // namespace mpm
