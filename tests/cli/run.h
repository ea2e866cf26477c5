#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

// Runs the built program as a user would.

/// A folder that is gone afterwards, with a scene in it: a closed box of 1 m, one face a light.
class Workplace {
public:
    Workplace();
    ~Workplace();
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;

    std::string operator/(const std::string& name) const { return (folder_ / name).string(); }
    std::string scene() const { return *this / "box.obj"; }
    /// Names of all that is there now but the scene and what run() keeps of the streams, sorted.
    std::vector<std::string> files() const;

private:
    std::filesystem::path folder_;
};

struct Outcome {
    int code = -1;  ///< exit code; -1: ended by a signal
    std::string out, err;

    /// True when standard error is exactly one line that begins "parallux: " and has the text.
    bool one_line(const std::string& text) const;
};

/// A program under way. It is ended after half a minute, whatever it does.
class Running {
public:
    Running(const Workplace& place, const std::vector<std::string>& arguments,
            const std::string& standard_output = {});
    ~Running();
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    /// Waits until standard error holds the text.
    void wait_for(const std::string& text) const;
    void send(int signal) const;
    Outcome wait();

private:
    std::string out_, err_;
    pid_t process_ = 0;
};

/// Runs it to its end; standard output to a file of choice, "-" for a closed one.
Outcome run(const Workplace& place, const std::vector<std::string>& arguments,
            const std::string& standard_output = {});

std::string read_file(const std::string& file);
void write_file(const std::string& file, const std::string& text);
