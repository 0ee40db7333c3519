#pragma once

#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// Tables, paragraphs and sentences of the document as Markdown, an empty line between them. Shares are in
/// percent and say no more than that, their intervals in whole percent.
std::string document_markdown(const Document& document);

}  // namespace mpm
