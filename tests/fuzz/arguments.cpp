#include <vector>

#include "cli/options.h"
#include "fuzz.h"

// The input is a command line, an argument a line.

using namespace parallux;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string text(reinterpret_cast<const char*>(data), size);
    std::replace(text.begin(), text.end(), '\0', ' ');  // which no argument holds
    std::vector<const char*> arguments{"parallux"};
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        text[end] = '\0';  // at size() there is one already
        arguments.push_back(text.data() + at);
        at = end + 1;
    }
    fuzz::ends_well({Fault::usage, Fault::input, Fault::output}, [&] {
        const Options options = parse_options(static_cast<int>(arguments.size()), arguments.data());
        fuzz::require(options.command != Command::print || !options.text.empty(),
                      "help that is not empty");
        const SolveSettings& solve = options.solve.solve;
        fuzz::require(solve.line_spacing >= 0 && solve.target_error >= 0 && solve.time_limit >= 0,
                      "settings within their ranges");
    });
    return 0;
}
