#include "cli/run.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;

namespace {

constexpr unsigned longest_run = 30;  // seconds

const char* const box_obj = R"(mtllib box.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
usemtl wall
f 1 2 3 4
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
usemtl light
f 5 8 7 6
)";

const char* const box_mtl = R"(newmtl wall
Kd 0.5 0.6 0.7
newmtl light
Kd 0 0 0
Ke 3 2 1
)";

}  // namespace

std::string read_file(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

void write_file(const std::string& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

Workplace::Workplace() {
    std::string pattern = (fs::temp_directory_path() / "parallux-test-XXXXXX").string();
    if (!mkdtemp(pattern.data()))
        throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    write_file(scene(), box_obj);
    write_file(*this / "box.mtl", box_mtl);
}

Workplace::~Workplace() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::vector<std::string> Workplace::files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
        std::string name = entry.path().filename().string();
        if (!name.starts_with("box.") && !name.starts_with("stream."))
            names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

bool Outcome::one_line(const std::string& text) const {
    return err.starts_with("parallux: ") && err.find(text) != std::string::npos &&
           err.find('\n') == err.size() - 1;
}

Running::Running(const Workplace& place, const std::vector<std::string>& arguments,
                 const std::string& standard_output)
    : out_(standard_output.empty() ? place / "stream.out" : standard_output),
      err_(place / "stream.err") {
    std::vector<char*> argv = {const_cast<char*>(PARALLUX_PROGRAM)};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    write_file(err_, "");
    // Until the program is there, no signal may meet what the tests do about signals.
    sigset_t ending, before;
    sigemptyset(&ending);
    for (int signal : {SIGINT, SIGTERM})
        sigaddset(&ending, signal);
    sigprocmask(SIG_BLOCK, &ending, &before);
    process_ = fork();
    if (process_ != 0)
        sigprocmask(SIG_SETMASK, &before, nullptr);
    if (process_ < 0)
        throw std::runtime_error("cannot fork");
    if (process_ == 0) {
        // Only what is allowed between fork and exec; the alarm outlives exec.
        alarm(longest_run);
        int in = open("/dev/null", O_RDONLY);
        int out =
            open(out_ == "-" ? "/dev/null" : out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dup2(in, 0);
        if (out_ == "-")
            close(1);
        else
            dup2(out, 1);
        dup2(err, 2);
        for (int descriptor : {in, out, err})
            if (descriptor > 2)
                close(descriptor);
        for (int signal : {SIGINT, SIGTERM})
            std::signal(signal, SIG_DFL);
        sigprocmask(SIG_SETMASK, &before, nullptr);
        execv(argv[0], argv.data());
        _exit(127);
    }
}

Running::~Running() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
}

void Running::wait_for(const std::string& text) const {
    for (unsigned tries = 0; tries < longest_run * 50; ++tries) {
        if (read_file(err_).find(text) != std::string::npos)
            return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("never came on standard error: " + text);
}

void Running::send(int signal) const {
    kill(process_, signal);
}

Outcome Running::wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            fs::is_regular_file(out_) ? read_file(out_) : "", read_file(err_)};
}

Outcome run(const Workplace& place, const std::vector<std::string>& arguments,
            const std::string& standard_output) {
    return Running(place, arguments, standard_output).wait();
}
