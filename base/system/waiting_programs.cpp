#include "base/system/waiting_programs.hpp"

#include <algorithm>
#include <utility>

namespace mpm {

WaitingPrograms::WaitingPrograms(std::string place, std::vector<std::string> command, double time_limit)
    : place_(std::move(place)), command_(std::move(command)), time_limit_(time_limit) {}

std::unique_ptr<RunningProgram> WaitingPrograms::take(const std::string& context) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [](const auto& program) { return !program->talk.is_ours(); });
  if (waiting_.empty())
    return take_new();
  const auto known = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&context](const auto& program) { return program->context == context; });
  const auto chosen = known == waiting_.end() ? waiting_.end() - 1 : known;
  std::unique_ptr<RunningProgram> program = std::move(*chosen);
  waiting_.erase(chosen);
  return program;
}

std::unique_ptr<RunningProgram> WaitingPrograms::take_new() const {
  return std::make_unique<RunningProgram>(place_, command_, time_limit_);
}

void WaitingPrograms::give_back(std::unique_ptr<RunningProgram> program) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(program));
}

void WaitingPrograms::end_all() {
  const std::lock_guard lock(mutex_);
  waiting_.clear();
}

}  // namespace mpm
