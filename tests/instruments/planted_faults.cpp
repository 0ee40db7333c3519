// Faults that a sanitizer must report, and a program with OpenMP on which it must be silent: without archer
// the thread sanitizer reports races there that are none.
//
//   planted_faults none|address|undefined|thread
#include <cstddef>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

namespace {

int past_the_end(const std::vector<int>& values) {
  return values.data()[values.size()];
}

int overflow(int value) {
  return value + 1;
}

int race() {
  int shared = 0;
  std::thread other([&shared] { ++shared; });
  ++shared;
  other.join();
  return shared;
}

double parallel_sum() {
  std::vector<double> values(1000, 1.0);
  double sum = 0.0;
#pragma omp parallel for num_threads(2) reduction(+ : sum)
  for (int i = 0; i < 1000; ++i)
    sum += values[static_cast<std::size_t>(i)];
#pragma omp parallel for num_threads(2)
  for (int i = 0; i < 1000; ++i)
    values[static_cast<std::size_t>(i)] = sum;
  return values.front();
}

}  // namespace

int main(int argc, char** argv) {
  const char* const fault = argc > 1 ? argv[1] : "none";
  if (std::strcmp(fault, "address") == 0)
    return past_the_end(std::vector<int>(static_cast<std::size_t>(argc)));
  if (std::strcmp(fault, "undefined") == 0)
    return overflow(std::numeric_limits<int>::max() - 2 + argc) == 0 ? 1 : 0;
  if (std::strcmp(fault, "thread") == 0)
    race();
  else if (std::strcmp(fault, "none") == 0)
    return parallel_sum() == 1000.0 ? 0 : 1;
  return 0;
}
