#pragma once

#include <string>
#include <vector>

#include "results/report/report_sections.hpp"

namespace mpm {

/// The sections of a page with their numbers, one below the other. Errors: GnuplotError.
std::string sections_html(const std::vector<ReportSection>& sections);

/// Links to them.
std::string contents_html(const std::vector<ReportSection>& sections);

}  // namespace mpm
