#include "bench/commands/commands.hpp"
#include "bench/console/manual_page.hpp"
#include "bench/console/output.hpp"
#include "bench/version.hpp"

namespace mpm {

void add_manual(CommandSet& commands) {
  commands.add("manual", "Print the manual page, for man", [&commands] {
    print_result(manual_page(commands.program(), mpmbench_version()));
    return ExitCode::done;
  });
}

void add_completion(CommandSet& commands) {
  commands.add("completion",
               "Print the completion of commands and options for bash: source <(mpmbench completion)",
               [&commands] {
                 print_result(bash_completion(commands.program()));
                 return ExitCode::done;
               });
}

}  // namespace mpm
