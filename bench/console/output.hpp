#pragma once

#include <string>
#include <string_view>

namespace mpm {

// All that the program says goes through here. Names come from files of others: control characters in them do
// not reach the terminal (plain_text()).

/// Writes on stdout. What is lost there (a full disk, a reader that is gone) ends no command;
/// results_arrived() says so at the end.
void print_result(std::string_view text);

/// Writes on stderr. What is lost there is lost.
void print_note(std::string_view text);

/// The end of a message about stopped work: finished work is kept `where` ("in FOLDER"), and `command`
/// resumes it.
std::string how_to_go_on(std::string_view where, std::string_view command);

/// A command line without `--discard`, which would delete what it is to go on with.
std::string without_discard(std::string command_line);

/// "3.2 s", "12 min", "3.1 h"
std::string duration_text(double seconds);

/// Whether all of print_result() has been written; when not, a note says why.
bool results_arrived();

/// Keeps the numbers of stdin, stdout and stderr for themselves where the caller has closed them: a file that
/// is opened later would take them, and be written into.
void occupy_closed_streams();

}  // namespace mpm
