#pragma once

#include <functional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

namespace parallux {

/// Adds options to one group of the help. `read` gets an option's text, and throws Fault::usage
/// when it does not like it.
struct OptionGroup {
    CLI::App& app;
    const char* name;

    CLI::Option* operator()(const char* option, const char* value, const char* help,
                            std::function<void(const std::string&)> read) const {
        return app.add_option_function<std::string>(option, std::move(read), help)
            ->type_name(value)
            ->group(name);
    }
};

}  // namespace parallux
