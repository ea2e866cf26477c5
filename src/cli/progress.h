#pragma once

#include <chrono>
#include <string>

#include "cli/options.h"

namespace parallux {

/// Tells on standard error how far a solve is: a bar on a terminal, a line every 10 % elsewhere, or
/// JSON lines. Called by solve(); answers false once the user has interrupted.
class ProgressReport {
public:
    explicit ProgressReport(ProgressMode mode);
    ~ProgressReport();
    ProgressReport(const ProgressReport&) = delete;
    ProgressReport& operator=(const ProgressReport&) = delete;

    bool operator()(const Progress& progress);

    /// Leaves the bar's line, so that the next text begins its own.
    void end();

private:
    enum class Form { off, bar, lines, json };

    bool due(const Progress& progress);
    void draw_bar(const Progress& progress);

    Form form_ = Form::off;
    std::string stage_;
    int told_ = -1;      // tenths of the stage that a line has told
    bool open_ = false;  // a bar stands on the terminal's line
    std::chrono::steady_clock::time_point last_{};
};

}  // namespace parallux
