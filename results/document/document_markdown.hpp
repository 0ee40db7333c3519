#pragma once

#include <string>

#include "results/document/document.hpp"

namespace mpm {

/// Tables and paragraphs of the document as Markdown. Shares are in percent and say no more than that, their
/// intervals in whole percent.
std::string document_markdown(const Document& document);

}  // namespace mpm
