#include <chrono>
#include <exception>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <catch2/catch.hpp>
#include <dirent.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/types.h>

#include "base/system/child_process.hpp"
#include "base/system/surroundings.hpp"

// Programs that answer lines by lines, and programs that do not.

namespace {

using namespace mpm;
using Catch::Matchers::Contains;

ChildProcess shell(const std::string& script) {
  return ChildProcess({"sh", "-c", script});
}

ChildProcess::Deadline soon() {
  return ChildProcess::in_seconds(20.0);
}

std::string failure_of(ChildProcess& child, double seconds) {
  try {
    const auto deadline = ChildProcess::in_seconds(seconds);
    child.send("hello", deadline);
    return fmt::format("no failure: {}", child.receive(deadline));
  } catch (const ChildFailure& failure) {
    return failure.what();
  }
}

std::size_t open_files() {
  std::size_t count = 0;
  DIR* const folder = ::opendir("/proc/self/fd");
  while (::readdir(folder) != nullptr)
    ++count;
  ::closedir(folder);
  return count;
}

/// A zombie waits for whoever is its parent now.
bool is_running(pid_t process) {
  std::ifstream status(fmt::format("/proc/{}/stat", process));
  std::string number, name, state;
  return status >> number >> name >> state && state != "Z";
}

constexpr const char* kEcho = "while read -r line; do [ -n \"$line\" ] && echo \"<$line>\"; done";

TEST_CASE("child process: it answers each line, however long, and lives from one to the next") {
  ChildProcess child({"cat"});
  for (const std::size_t length : {1u, 100u, 1000000u, 5000000u}) {
    const std::string line(length, 'x');
    child.send(line, soon());
    CHECK(child.receive(soon()) == line);
  }
  CHECK(child.processor_seconds() > 0.0);
}

TEST_CASE("child process: an empty line follows each one, and empty lines of the program are passed over") {
  ChildProcess child = shell("while read -r line; do echo; printf '<%s>\\r\\n' \"$line\"; done");
  child.send("one", soon());
  CHECK(child.receive(soon()) == "<one>");
  CHECK(child.receive(soon()) == "<>");
}

TEST_CASE("child process: programs in several threads do not keep each other's pipes") {
  const std::size_t files = open_files();
  std::vector<std::thread> threads;
  std::vector<std::string> answers(8);
  for (std::size_t i = 0; i < answers.size(); ++i)
    threads.emplace_back([&answers, i] {
      for (int round = 0; round < 10; ++round) {
        ChildProcess child = shell(kEcho);
        child.send(std::to_string(i), soon());
        answers[i] = child.receive(soon());
      }
    });
  for (std::thread& thread : threads)
    thread.join();
  for (std::size_t i = 0; i < answers.size(); ++i)
    CHECK(answers[i] == fmt::format("<{}>", i));
  CHECK(open_files() == files);
  // The second one has no file that the first one has not: the pipes of the first are not among them.
  const char* const list = "ls /proc/self/fd | wc -l; cat";
  ChildProcess first = shell(list);
  const std::string files_of_first = first.receive(soon());
  ChildProcess second = shell(list);
  CHECK(second.receive(soon()) == files_of_first);
}

TEST_CASE("child process: one that hangs is given up in time, and what it started with it") {
  ChildProcess child = shell("sleep 1000 & echo $!; wait");
  const pid_t grandchild = std::stoi(child.receive(soon()));
  const auto start = std::chrono::steady_clock::now();
  CHECK_THAT(failure_of(child, 0.1), Contains("program `sh -c ") && Contains("did not answer in time"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(10));
  for (int look = 0; look < 2000 && is_running(grandchild); ++look)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK_FALSE(is_running(grandchild));
  CHECK_THAT(failure_of(child, 1.0), Contains("has ended before"));
}

TEST_CASE(
    "child process: one that dies says how, with the end of its stderr, and does not end this program") {
  ChildProcess fails = shell("echo 'no module named x' >&2; exit 3");
  CHECK_THAT(failure_of(fails, 20.0),
             Contains("ended with code 3; at the end of its stderr: no module named x"));
  ChildProcess crashes = shell("read -r line; kill -SEGV $$");
  CHECK_THAT(failure_of(crashes, 20.0), Contains("ended by signal 11"));
  ChildProcess deaf = shell("exec 0<&- 1>&-; sleep 1000");
  CHECK_THAT(failure_of(deaf, 20.0), Contains("closed its stdin or stdout"));
  CHECK_THROWS_WITH(ChildProcess({"/no/such/program"}),
                    Contains("program `/no/such/program` cannot be started"));
}

TEST_CASE("child process: what is killed from outside, or cannot be started, was not asked") {
  const auto ask = [](const std::string& script) {
    ChildProcess child = shell(script);
    child.send("hello", soon());
    child.receive(soon());
  };
  // The shell is the program, or reports the end of what it runs.
  for (const std::string killed : {"$$", "0"})
    for (const char* signal : {"HUP", "INT", "KILL", "TERM"})
      CHECK_THROWS_AS(ask(fmt::format("read -r a; sh -c 'kill -{} {}'; exit $?", signal, killed)),
                      SurroundingsFailure);
  for (const char* fault : {"kill -SEGV $$", "kill -ABRT $$", "kill -BUS $$", "exit 1", "exit 126",
                            "exit 255", "sh -c 'kill -SEGV $$'; exit $?"})
    CHECK_THROWS_AS(ask(fmt::format("read -r a; {}", fault)), ChildFailure);
  CHECK_THROWS_WITH(ask("read -r a; echo 'gone' >&2; kill -9 $$"),
                    Contains("ended by signal 9 (Killed); at the end of its stderr: gone"));
}

TEST_CASE("child process: without files there is none, and that says nothing of the program") {
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const auto open = static_cast<rlim_t>(open_files() - 3);  // without ".", "..", and the list itself
  int shortages = 0;
  for (rlim_t more = 0; more < 12; ++more) {
    rlimit few = before;
    few.rlim_cur = open + more;
    ::setrlimit(RLIMIT_NOFILE, &few);
    try {
      ChildProcess child({"cat"});
      child.send("hello", soon());
      child.receive(soon());
    } catch (const std::exception& error) {
      ++shortages;
      ::setrlimit(RLIMIT_NOFILE, &before);
      INFO(error.what());
      CHECK(is_of_surroundings(error));
    }
    ::setrlimit(RLIMIT_NOFILE, &before);
  }
  CHECK(shortages > 2);
  CHECK(shortages < 12);
}

TEST_CASE("child process: one that floods stderr is heard all the same, and the end of the flood is kept") {
  ChildProcess child =
      shell("yes flood | head -c 3000000 >&2; echo last words >&2; read -r a; echo done; exit 1");
  child.send("go on", soon());
  CHECK(child.receive(soon()) == "done");
  const std::string message = failure_of(child, 20.0);
  CHECK_THAT(message, Contains("last words"));
  CHECK(message.size() < 800);
}

TEST_CASE("child process: one that writes without end of line is given up") {
  ChildProcess child = shell("tr '\\0' x < /dev/zero");
  CHECK_THAT(failure_of(child, 60.0), Contains("bytes that nobody asked for"));
}

}  // namespace
