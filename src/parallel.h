#pragma once

#include <cstddef>
#include <functional>

// The one way to loop in parallel.

namespace parallux {

/// Threads that a request means: 0 is every core.
unsigned thread_count(unsigned requested);

/// Calls body(begin, end, worker) over [0, count) in pieces of at most `grain`; `worker` < threads,
/// and no two calls that run at once have the same. Pieces run in any order: the body's result must
/// not depend on it. The first exception a body throws is rethrown after all have ended.
void parallel_for(unsigned threads, std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t, unsigned)>& body);

}  // namespace parallux
