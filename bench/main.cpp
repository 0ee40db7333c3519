#include <csignal>
#include <cstdlib>

#include <unistd.h>

#include "bench/command_line.hpp"
#include "bench/console/output.hpp"

namespace {

/// The BLAS under Ipopt must not start threads: they would compete with the workers, and the workers are
/// forked from this process. The BLAS reads its environment when it is loaded, so the program sets the
/// variable and starts itself once more.
void use_single_threaded_blas(char** argv) {
  if (std::getenv("OPENBLAS_NUM_THREADS") != nullptr)
    return;
  ::setenv("OPENBLAS_NUM_THREADS", "1", 1);
  ::execv("/proc/self/exe", argv);  // returns only when it fails: then go on as we are
}

}  // namespace

int main(int argc, char** argv) {
  mpm::occupy_closed_streams();
  use_single_threaded_blas(argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of its size is an error of write(), with a text
  std::signal(SIGPIPE, SIG_IGN);  // so is a reader that is gone: it must not end a campaign
  const mpm::CommandResult result = mpm::execute(argc, argv);
  const bool done = result.code == mpm::ExitCode::done;
  (done ? mpm::print_result : mpm::print_note)(result.message);
  return static_cast<int>(!mpm::results_arrived() && done ? mpm::ExitCode::not_finished : result.code);
}
