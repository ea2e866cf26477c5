#pragma once

#include <string>

// Standard output and error, checked and kept to one line where that is promised.

namespace parallux {

/// Before anything is opened: a standard stream that the caller has closed must not become the
/// number of a file of ours. Writing to a closed standard output then fails as it should; so does
/// writing to a pipe that nobody reads, or beyond a limit on files, instead of ending the program
/// unheard.
void guard_standard_streams();

/// Writes all of it to standard output; throws Fault::output when it is closed or full.
void print(const std::string& text);

/// The same, but returns the reason as errno, or 0.
int try_print(const std::string& text);

/// One line on standard error. Control characters, which names in a scene may hold, are shown as
/// \xNN: they cannot fake a second line or steer the terminal.
void complain(const std::string& line);

/// Text without control characters.
std::string printable(const std::string& text);

/// To be called in a catch block: says what went wrong and returns the exit code.
int report_failure();

}  // namespace parallux
