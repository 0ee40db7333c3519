#pragma once

namespace mpm {

/// The style sheet of the report (report_style.css): one column of text, two panels side by side if there is
/// room, tables that scroll by themselves on a narrow screen, and a form for print.
extern const char* const kReportStyle;

}  // namespace mpm
