#include "tests/plants/allocation_counter.hpp"

#include <atomic>
#include <cstddef>
#include <new>

namespace {
std::atomic<std::size_t> allocations{0};
}

std::size_t allocation_count() {
  return allocations.load();
}

// The linker (ld --wrap, see CMakeLists.txt) sends each call of f to __wrap_f and each of __real_f to f.
// Every block thus still comes from its usual place, and freeing it needs no change. _Znwm and
// _ZnwmSt11align_val_t are operator new(size) and operator new(size, alignment); the array forms start with
// _Zna.
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void* __real__Znwm(std::size_t size);
void* __real__Znam(std::size_t size);
void* __real__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment);
void* __real__ZnamSt11align_val_t(std::size_t size, std::align_val_t alignment);

void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}

void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __real_calloc(count, size);
}

void* __wrap_realloc(void* block, std::size_t size) {
  ++allocations;
  return __real_realloc(block, size);
}

void* __wrap__Znwm(std::size_t size) {
  ++allocations;
  return __real__Znwm(size);
}

void* __wrap__Znam(std::size_t size) {
  ++allocations;
  return __real__Znam(size);
}

void* __wrap__ZnwmSt11align_val_t(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  return __real__ZnwmSt11align_val_t(size, alignment);
}

void* __wrap__ZnamSt11align_val_t(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  return __real__ZnamSt11align_val_t(size, alignment);
}
}
