#pragma once

namespace mpm {

/// The style sheet of the report (report_style.css): one column of text, panels two abreast where there is
/// room, tables that scroll by themselves on a narrow screen, and a print form.
extern const char* const kReportStyle;

}  // namespace mpm
