#pragma once

#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// What the sections of the document have for programs, as one object. A number that does not exist or is
/// infinite is null.
std::string document_json(const Document& document);

}  // namespace mpm
