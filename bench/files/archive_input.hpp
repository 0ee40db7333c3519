#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// An archive cannot be read: wrong input, whereas one that cannot be written is a run that cannot be
/// finished.
class BadArchive : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// stream_archive() for an archive that a command was given. It and its records throw BadArchive, these also
/// when somebody has written into the file since.
Campaign stream_input(const std::string& archive);

/// The experiment of this index. Throws InputError that names the existing indices.
ExperimentRecord experiment_of(const Campaign& campaign, std::int64_t index);

}  // namespace mpm
