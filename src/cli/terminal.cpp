#include "cli/terminal.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <unistd.h>

#include "parallux/error.h"

namespace parallux {

namespace {

/// errno, or 0 when all is written.
int write_all(int descriptor, const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
        ssize_t n = ::write(descriptor, text.data() + done, text.size() - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return errno;
        done += static_cast<std::size_t>(n);
    }
    return 0;
}

}  // namespace

void guard_standard_streams() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    // open() gives the lowest free number, so each gap is filled in turn. Opened the wrong way
    // round, standard output refuses every write.
    const int modes[] = {O_WRONLY, O_RDONLY, O_WRONLY};
    for (int stream = 0; stream < 3; ++stream)
        if (fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            (void)open("/dev/null", modes[stream]);
}

int try_print(const std::string& text) {
    return write_all(STDOUT_FILENO, text);
}

void print(const std::string& text) {
    if (int reason = try_print(text))
        throw Error(Fault::output,
                    std::string("standard output: cannot write: ") + std::strerror(reason));
}

std::string printable(const std::string& text) {
    static constexpr char hex[] = "0123456789abcdef";
    std::string result;
    for (char c : text) {
        auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte != 0x7f)
            result += c;
        else
            (((result += "\\x") += hex[byte >> 4])) += hex[byte & 15];
    }
    return result;
}

void complain(const std::string& line) {
    // Nobody is left to tell when standard error itself fails.
    (void)write_all(STDERR_FILENO, printable(line) + "\n");
}

int report_failure() {
    try {
        throw;
    } catch (const Error& error) {
        complain(std::string("parallux: ") + error.what());
        return static_cast<int>(error.fault());
    } catch (const std::bad_alloc&) {
        complain("parallux: not enough memory; use fewer patches or a smaller picture");
        return static_cast<int>(Fault::memory);
    } catch (const std::exception& error) {
        complain(std::string("parallux: internal error: ") + error.what() +
                 "; please report it with the scene");
        return static_cast<int>(Fault::internal);
    }
}

}  // namespace parallux
