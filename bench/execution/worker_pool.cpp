#include "bench/execution/worker_pool.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <exception>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/system/socket_bytes.hpp"
#include "base/system/surroundings.hpp"

namespace mpm {
namespace {

/// Header of a message: its length and, if it comes from a worker, how the task ended.
struct Header {
  TaskEnd end;
  std::int64_t size;
};

bool send_message(int socket, const std::string& bytes, TaskEnd end = TaskEnd::answered) {
  const Header header{end, static_cast<std::int64_t>(bytes.size())};
  return send_bytes(socket, &header, sizeof header) && send_bytes(socket, bytes.data(), bytes.size());
}

bool receive_message(int socket, std::string& bytes, TaskEnd& end) {
  Header header{};
  if (receive_bytes(socket, &header, sizeof header) != Received::all)
    return false;
  end = header.end;
  bytes.resize(static_cast<std::size_t>(header.size));
  return receive_bytes(socket, bytes.data(), bytes.size()) == Received::all;
}

[[noreturn]] void work_until_closed(int socket, const WorkerPool::Work& work) {
  std::string request, answer;
  TaskEnd end = TaskEnd::answered;
  while (receive_message(socket, request, end)) {
    try {
      answer = work(request);
    } catch (const std::exception& error) {
      answer = what_happened(error);
      end = is_of_surroundings(error) ? TaskEnd::surroundings : TaskEnd::crashed;
    }
    if (!send_message(socket, answer, end))
      break;
  }
  // Not exit(): destructors and buffers belong to the parent.
  ::_exit(0);
}

}  // namespace

/// One worker process and the parent's end of its socket.
class WorkerPool::Worker {
 public:
  Worker(const Work& work, const std::vector<std::unique_ptr<Worker>>& siblings) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
      throw std::system_error(errno, std::generic_category(), "no socket for a worker process");
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ < 0) {
      const int error = errno;
      ::close(ends[0]);
      ::close(ends[1]);
      throw std::system_error(error, std::generic_category(), "no worker process");
    }
    if (pid_ == 0) {
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (::getppid() != parent)
        ::_exit(0);  // the parent died before the line above
      ::close(ends[0]);
      for (const auto& sibling : siblings)
        ::close(sibling->socket_);
      work_until_closed(ends[1], work);
    }
    ::close(ends[1]);
    socket_ = ends[0];
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  ~Worker() {
    ::close(socket_);
    if (pid_ <= 0)
      return;
    ::kill(pid_, SIGKILL);  // idle, or given up: there is nothing it could still finish
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  /// Sends a request. If the worker is gone, this shows when its answer is read.
  void start(std::int64_t task, const std::string& request) {
    task_ = task;
    send_message(socket_, request);
  }

  /// The answer to the task under way; blocks until it is whole.
  TaskResult finish() {
    TaskResult result{std::exchange(task_, kNoTask), TaskEnd::answered, {}};
    if (!receive_message(socket_, result.bytes, result.end)) {
      const ProcessEnd end = how_it_ended();
      result.end = end.from_outside ? TaskEnd::surroundings : TaskEnd::crashed;
      result.bytes = fmt::format("worker process {}", end.text);
    }
    return result;
  }

  bool idle() const { return task_ == kNoTask; }
  int socket() const { return socket_; }
  bool alive() const { return pid_ > 0; }

 private:
  static constexpr std::int64_t kNoTask = -1;

  ProcessEnd how_it_ended() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return process_end(status);
  }

  pid_t pid_ = -1;
  int socket_ = -1;
  std::int64_t task_ = kNoTask;
};

WorkerPool::WorkerPool(int jobs, Work work) : work_(std::move(work)) {
  const auto wanted = static_cast<std::size_t>(std::max(jobs, 1));
  workers_.reserve(wanted);
  while (workers_.size() < wanted)
    workers_.push_back(std::make_unique<Worker>(work_, workers_));
}

WorkerPool::~WorkerPool() = default;

bool WorkerPool::has_idle() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const auto& worker) { return worker->idle(); });
}

bool WorkerPool::has_busy() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const auto& worker) { return !worker->idle(); });
}

void WorkerPool::start(std::int64_t id, const std::string& request) {
  const auto idle =
      std::find_if(workers_.begin(), workers_.end(), [](const auto& worker) { return worker->idle(); });
  assert(idle != workers_.end());
  (*idle)->start(id, request);
}

TaskResult WorkerPool::wait() {
  constexpr std::chrono::milliseconds kForever(-1);  // no limit, as for poll()
  for (;;)
    if (std::optional<TaskResult> result = wait_for(kForever))
      return std::move(*result);
}

std::optional<TaskResult> WorkerPool::wait_for(std::chrono::milliseconds longest) {
  assert(has_busy());
  std::vector<pollfd> watched(workers_.size());
  for (std::size_t w = 0; w < workers_.size(); ++w)  // poll() ignores negative descriptors
    watched[w] = {workers_[w]->idle() ? -1 : workers_[w]->socket(), POLLIN, 0};
  const int count = ::poll(watched.data(), watched.size(), static_cast<int>(longest.count()));
  if (count < 0 && errno != EINTR)
    throw std::system_error(errno, std::generic_category(), "waiting for worker processes");
  if (count <= 0)
    return std::nullopt;
  std::size_t ready = 0;
  while (watched[ready].revents == 0)
    ++ready;
  return finish(ready);
}

TaskResult WorkerPool::finish(std::size_t position) {
  TaskResult result = workers_[position]->finish();
  if (!workers_[position]->alive() || result.end == TaskEnd::surroundings) {  // nobody knows its state
    workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(position));
    workers_.push_back(std::make_unique<Worker>(work_, workers_));
  }
  return result;
}

std::optional<TaskResult> next_finding(WorkerPool& pool, const StopRequest& stop) {
  constexpr std::chrono::milliseconds kLook(100);
  std::optional<TaskResult> result = pool.wait_for(kLook);
  if (result && result->end != TaskEnd::answered && requested(stop))
    return std::nullopt;
  return result;
}

}  // namespace mpm
