#pragma once

#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// Writes the tables, paragraphs and sentences of the document as Markdown, with an empty line between them.
/// Shares are in percent but without the sign, their intervals in whole percent.
std::string document_markdown(const Document& document);

}  // namespace mpm
