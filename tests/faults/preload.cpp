#include <atomic>
#include <csignal>
#include <cstdlib>
#include <new>

#include <dlfcn.h>
#include <unistd.h>

// Loaded before the program (LD_PRELOAD): the FAULT_NEW-th allocation by `new` fails, counted from
// where the program first watches a signal (before that, libraries set themselves up), and each
// fsync takes FAULT_FSYNC seconds longer. FAULT_COUNT: the allocations are told on standard error.

namespace {

long setting(const char* name) {
    const char* value = std::getenv(name);
    return value ? std::atol(value) : 0;
}

std::atomic<bool> counting{false};
std::atomic<long> allocations{0};

void* allocate(std::size_t size) {
    static const long failing = setting("FAULT_NEW");
    if (counting && ++allocations == failing)
        throw std::bad_alloc();
    if (void* place = std::malloc(size ? size : 1))
        return place;
    throw std::bad_alloc();
}

struct Teller {
    ~Teller() {
        if (setting("FAULT_COUNT")) {
            char text[32];
            char* digit = text + sizeof text;
            *--digit = '\n';
            for (long n = allocations; n > 0; n /= 10)
                *--digit = static_cast<char>('0' + n % 10);
            (void)!write(STDERR_FILENO, digit,
                         static_cast<std::size_t>(text + sizeof text - digit));
        }
    }
} teller;

}  // namespace

void* operator new(std::size_t size) {
    return allocate(size);
}
void* operator new[](std::size_t size) {
    return allocate(size);
}
void operator delete(void* place) noexcept {
    std::free(place);
}
void operator delete[](void* place) noexcept {
    std::free(place);
}
void operator delete(void* place, std::size_t) noexcept {
    std::free(place);
}
void operator delete[](void* place, std::size_t) noexcept {
    std::free(place);
}

extern "C" int sigaction(int number, const struct sigaction* action, struct sigaction* before) {
    static const auto next =
        reinterpret_cast<int (*)(int, const struct sigaction*, struct sigaction*)>(
            dlsym(RTLD_NEXT, "sigaction"));
    counting = counting || number == SIGTERM;
    return next(number, action, before);
}

extern "C" int fsync(int descriptor) {
    static const auto next = reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, "fsync"));
    static const long longer = setting("FAULT_FSYNC");
    if (longer > 0)
        sleep(static_cast<unsigned>(longer));
    return next(descriptor);
}
