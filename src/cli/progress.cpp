#include "cli/progress.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>
#include <nlohmann/json.hpp>

#include "cli/interrupt.h"
#include "cli/terminal.h"

namespace parallux {

namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

double rate(const Progress& p) {
    return p.seconds > 0 ? static_cast<double>(p.lines) / p.seconds : 0;
}

/// Seconds to the end of the stage at its pace so far; below 0: not known yet.
double left(const Progress& p) {
    return p.done > 0 ? p.seconds * (1 - p.done) / p.done : -1;
}

std::string describe(const Progress& p) {
    char text[96];
    int size = std::snprintf(text, sizeof text, "%3d %%", static_cast<int>(p.done * 100));
    auto more = [&](const char* format, double value) {
        size +=
            std::snprintf(text + size, sizeof text - static_cast<std::size_t>(size), format, value);
    };
    if (p.lines > 0)
        more("  %.3g M lines/s", rate(p) / 1e6);
    if (left(p) >= 0)
        more("  %.0f s left", left(p));
    return text;
}

std::string formatted(const char* format, double value) {
    char text[48];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string time(double seconds) {
    return formatted(seconds < 10 ? "%.1f s" : "%.0f s", seconds);
}

std::string object(const Progress& p) {
    Json line = {{"stage", p.stage},     {"done", p.done},
                 {"lines", p.lines},     {"lines_per_second", rate(p)},
                 {"seconds", p.seconds}, {"seconds_left", nullptr}};
    if (left(p) >= 0)
        line["seconds_left"] = left(p);
    if (const Forecast* f = p.forecast)
        line["forecast"] = {{"error", f->error},
                            {"target", f->target},
                            {"seconds_so_far", f->seconds_so_far},
                            {"bundles", f->bundles},
                            {"seconds", f->seconds}};
    return line.dump();
}

}  // namespace

std::string percent(double share) {
    return formatted("%.3g %%", 100 * share);
}

ProgressReport::ProgressReport(ProgressMode mode, bool quiet) : quiet_(quiet) {
    if (mode == ProgressMode::json)
        form_ = Form::json;
    else if (mode == ProgressMode::on)
        form_ = Form::bar;
    else if (mode == ProgressMode::automatic)
        form_ = isatty(STDERR_FILENO) ? Form::bar : Form::lines;
}

ProgressReport::~ProgressReport() {
    end();
}

bool ProgressReport::operator()(const Progress& progress) {
    if (progress.forecast && form_ == Form::json) {
        complain(object(progress));
    } else if (progress.forecast) {
        tell(*progress.forecast);
    } else if (form_ != Form::off && due(progress)) {
        if (form_ == Form::bar)
            draw_bar(progress);
        else if (form_ == Form::json)
            complain(object(progress));
        else
            complain(stage_ + " " + describe(progress));
    }
    return !interrupted();
}

/// A new stage is always told; then lines by tenths, the others ten times a second and at the end.
bool ProgressReport::due(const Progress& progress) {
    if (stage_ != progress.stage) {
        end();
        stage_ = progress.stage;
        told_ = -1;
        last_ = {};
    }
    int tenths = static_cast<int>(std::clamp(progress.done, 0.0, 1.0) * 10);
    auto now = std::chrono::steady_clock::now();
    bool ended = progress.done >= 1 && told_ < 10;
    if (form_ == Form::lines ? tenths <= told_ : !ended && now - last_ < 100ms)
        return false;
    told_ = tenths;
    last_ = now;
    return true;
}

void ProgressReport::draw_bar(const Progress& progress) {
    constexpr int width = 30;
    int full = static_cast<int>(std::clamp(progress.done, 0.0, 1.0) * width);
    std::string bar(static_cast<std::size_t>(full), '#');
    bar.resize(width, '.');
    // Back to the line's start, the text, and whatever a longer text before it has left.
    std::fprintf(stderr, "\r%-10s [%s] %s\033[K", stage_.c_str(), bar.c_str(),
                 describe(progress).c_str());
    std::fflush(stderr);
    open_ = true;
}

void ProgressReport::tell(const Forecast& forecast) {
    if (quiet_)
        return;
    end();
    stage_.clear();  // what comes is told anew
    complain(percent(forecast.error) + " after " + time(forecast.seconds_so_far) + "; " +
             percent(forecast.target) + " wanted: about " + time(forecast.seconds) + " more");
}

void ProgressReport::end() {
    if (open_)
        std::fputc('\n', stderr);
    open_ = false;
}

}  // namespace parallux
