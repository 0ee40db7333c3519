#pragma once

#include <cstddef>
#include <functional>

namespace mpm {

/// Calls body(index, thread) for each index below `count` in `threads` threads, in any order; `thread` is
/// below `threads`. Throws the exception of the first index whose call throws, as a loop in one thread would,
/// and begins no more calls of later indices. Throws std::runtime_error, and calls nothing, if so many
/// threads cannot be made. No thread is left on return. This is the only loop of the program that runs in
/// threads.
void for_each_in_threads(std::size_t count, int threads,
                         const std::function<void(std::size_t index, std::size_t thread)>& body);

}  // namespace mpm
