#pragma once

#include <string>
#include <string_view>

namespace mpm {

// Everything that the program prints goes through here. It contains names from other people's files: control
// characters in them do not reach the terminal (plain_text()).

/// Writes on stdout. Lost output (a full disk, a reader that is gone) does not end the command;
/// results_arrived() reports it at the end.
void print_result(std::string_view text);

/// Writes on stderr. Nothing reports lost output.
void print_note(std::string_view text);

/// The end of a message about stopped work: finished work is kept `where` ("in FOLDER"), and `command`
/// resumes it.
std::string how_to_go_on(std::string_view where, std::string_view command);

/// A command line without `--discard`, which would delete the work that the command is to resume.
std::string without_discard(std::string command_line);

/// "3.2 s", "12 min", "3.1 h"
std::string duration_text(double seconds);

/// Whether all output of print_result() has been written. If not, prints a note with the possible reasons.
bool results_arrived();

/// Occupies the numbers of stdin, stdout and stderr that the caller has closed. Otherwise a file that is
/// opened later would get such a number, and output would go into it.
void occupy_closed_streams();

}  // namespace mpm
