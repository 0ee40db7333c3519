#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "results/archive/campaign.hpp"

namespace mpm {

/// An archive cannot be read. This is wrong input, whereas an archive that cannot be written is a run that
/// cannot be finished.
class BadArchive : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// stream_archive() for an archive that a command was given. The call and the records throw BadArchive; the
/// records also if somebody has written into the file since.
Campaign stream_input(const std::string& archive);

/// The experiment of this index. Throws InputError, which names the existing indices, if there is none.
ExperimentRecord experiment_of(const Campaign& campaign, std::int64_t index);

}  // namespace mpm
