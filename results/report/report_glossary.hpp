#pragma once

#include <string>

namespace mpm {

/// Explains the words of the thesis that the page uses, for the margin. Each has the anchor "term-NAME".
/// `chain`: include the words of the thesis's chain.
std::string glossary_html(bool chain);

}  // namespace mpm
