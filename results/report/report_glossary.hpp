#pragma once

#include <string>

namespace mpm {

/// The words of the thesis that the page uses, for the margin; each has the anchor "term-NAME".
/// `chain`: those of the thesis's chain, too.
std::string glossary_html(bool chain);

}  // namespace mpm
