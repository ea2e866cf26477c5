#pragma once

#include <span>

namespace parallux {

/// Instruction sets that vector code can run on, narrowest first; "plain" is code without vectors.
/// All give the same bits.
std::span<const char* const> vector_sets();

/// The one in use: the widest of this machine, or that set by use_vectors().
const char* vectors_in_use();

/// Runs vector code on this set from now on, for all threads; not while a loop runs. "auto" is the
/// widest. False, and no change: there is no such set, or this machine lacks it.
bool use_vectors(const char* set);

}  // namespace parallux
