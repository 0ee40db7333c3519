#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

// Which programs of somebody else this process may start: none, but those that the user has named in a file
// of one's own. A study that is read from an archive or from the part of a campaign names others' programs,
// and to open a file must start nothing.

namespace mpm {

/// A program that is to be started and that nobody has allowed. No InputError, so that no loop counts it as
/// an outcome of its own: it ends the command.
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
