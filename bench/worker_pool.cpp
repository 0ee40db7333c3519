#include "bench/worker_pool.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
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

namespace mpm {
namespace {

/// Header of an answer: whether it is one, and its length.
struct AnswerHeader {
  std::int64_t failed;
  std::int64_t size;
};

bool send_all(int socket, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket, next, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR)
      continue;
    if (sent <= 0)
      return false;
    next += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  char* next = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t received = ::recv(socket, next, size, 0);
    if (received < 0 && errno == EINTR)
      continue;
    if (received <= 0)
      return false;
    next += received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

[[noreturn]] void work_until_closed(int socket, const std::function<std::string(std::int64_t)>& work) {
  std::int64_t index = 0;
  while (receive_all(socket, &index, sizeof index)) {
    AnswerHeader header{0, 0};
    std::string bytes;
    try {
      bytes = work(index);
    } catch (const std::exception& error) {
      header.failed = 1;
      bytes = error.what();
    }
    header.size = static_cast<std::int64_t>(bytes.size());
    if (!send_all(socket, &header, sizeof header) || !send_all(socket, bytes.data(), bytes.size()))
      break;
  }
  // Not exit(): destructors and buffers belong to the parent.
  ::_exit(0);
}

/// One worker process and the parent's end of its socket.
class Worker {
 public:
  Worker(const std::function<std::string(std::int64_t)>& work, const std::vector<Worker>& siblings) {
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
      for (const Worker& sibling : siblings)
        ::close(sibling.socket_);
      work_until_closed(ends[1], work);
    }
    ::close(ends[1]);
    socket_ = ends[0];
  }

  Worker(Worker&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)), socket_(std::exchange(other.socket_, -1)), task_(other.task_) {}
  Worker& operator=(Worker&&) = delete;

  ~Worker() {
    if (socket_ >= 0)
      ::close(socket_);
    if (pid_ <= 0)
      return;
    ::kill(pid_, SIGKILL);  // idle, or given up: there is nothing it could still finish
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  bool start(std::int64_t index) {
    task_ = index;
    return send_all(socket_, &index, sizeof index);
  }

  /// The answer to the task under way; blocks until it is whole.
  TaskResult finish() {
    TaskResult result{task_, true, {}};
    AnswerHeader header{};
    if (receive_all(socket_, &header, sizeof header)) {
      result.bytes.resize(static_cast<std::size_t>(header.size));
      if (receive_all(socket_, result.bytes.data(), result.bytes.size())) {
        result.crashed = header.failed != 0;
        return result;
      }
    }
    result.bytes = how_it_ended();
    return result;
  }

  int socket() const { return socket_; }
  bool alive() const { return pid_ > 0; }

 private:
  std::string how_it_ended() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return WIFSIGNALED(status) ? fmt::format("worker process ended by signal {} ({})", WTERMSIG(status),
                                             ::strsignal(WTERMSIG(status)))
                               : fmt::format("worker process ended with code {}", WEXITSTATUS(status));
  }

  pid_t pid_ = -1;
  int socket_ = -1;
  std::int64_t task_ = -1;
};

}  // namespace

void run_in_workers(std::int64_t count, int jobs, const std::function<std::string(std::int64_t)>& work,
                    const std::function<void(TaskResult)>& deliver) {
  std::vector<Worker> workers;
  std::int64_t next = 0;
  std::int64_t delivered = 0;
  const auto hand_out = [&](Worker& worker) {
    if (next < count)
      worker.start(next++);  // a worker that is gone shows when its answer is read
  };
  const auto wanted = static_cast<std::size_t>(std::min<std::int64_t>(std::max(jobs, 1), count));
  workers.reserve(wanted);
  while (workers.size() < wanted) {
    workers.emplace_back(work, workers);
    hand_out(workers.back());
  }

  std::vector<pollfd> watched;
  while (delivered < count) {
    watched.clear();
    for (const Worker& worker : workers)
      watched.push_back({worker.socket(), POLLIN, 0});
    if (::poll(watched.data(), watched.size(), -1) < 0) {
      if (errno == EINTR)
        continue;
      throw std::system_error(errno, std::generic_category(), "waiting for worker processes");
    }
    for (std::size_t w = 0; w < watched.size(); ++w) {
      if (watched[w].revents == 0)
        continue;
      TaskResult result = workers[w].finish();
      if (!workers[w].alive()) {
        std::vector<Worker> kept;
        kept.reserve(wanted);
        for (std::size_t i = 0; i < workers.size(); ++i)
          if (i != w)
            kept.push_back(std::move(workers[i]));
        workers = std::move(kept);
        if (next < count)
          workers.emplace_back(work, workers);
        if (next < count)
          hand_out(workers.back());
        ++delivered;
        deliver(std::move(result));
        break;  // positions have changed: watch anew
      }
      hand_out(workers[w]);
      ++delivered;
      deliver(std::move(result));
    }
  }
}

}  // namespace mpm
