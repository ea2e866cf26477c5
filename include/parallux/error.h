#pragma once

#include <stdexcept>
#include <string>

namespace parallux {

/// What kind of thing went wrong; the value is the program's exit code.
enum class Fault {
    usage = 2,     ///< an option or argument that makes no sense
    input = 3,     ///< a scene or table that cannot be read or is invalid
    output = 4,    ///< a file that cannot be written; an older one stays whole
    memory = 5,    ///< more memory needed than allowed, said before it is taken
    internal = 70  ///< an internal check failed
};

/// The one exception the library throws. `what()` is one line: what is wrong, in which file,
/// where in it, and what would help.
class Error : public std::runtime_error {
public:
    Error(Fault fault, const std::string& message) : std::runtime_error(message), fault_(fault) {}

    Fault fault() const noexcept { return fault_; }

private:
    Fault fault_;
};

}  // namespace parallux
