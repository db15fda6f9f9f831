// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/child_process.h"

#include "plumbline/base/error.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumbline {
namespace {

// Only functions that are safe between fork and exec.
[[noreturn]] void Become(char* const* arguments, int log, pid_t parent, rlim_t memory) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it died before the line above
  if (memory != RLIM_INFINITY) {
    const rlimit limit{memory, memory};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const int input = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(input, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::execv(arguments[0], arguments);
  constexpr char kMessage[] = "cannot start the program\n";
  (void)!::write(STDERR_FILENO, kMessage, sizeof(kMessage) - 1);
  ::_exit(127);
}

[[noreturn]] void FailStart(const std::string& what) {
  throw InputError(what + ": " + std::error_code(errno, std::generic_category()).message());
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command,
                           const std::filesystem::path& log,
                           std::optional<int> memory_mb) {
  PLUMBLINE_CHECK(!command.empty(), "a program to start");
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) FailStart("cannot write " + log.string());
  const pid_t parent = ::getpid();
  const rlim_t memory = memory_mb ? static_cast<rlim_t>(*memory_mb) << 20 : RLIM_INFINITY;
  id_ = ::fork();
  if (id_ == 0) Become(arguments.data(), file, parent, memory);
  ::close(file);
  if (id_ < 0) FailStart("cannot start " + command[0]);
  ::setpgid(id_, id_);  // here too: whichever of the two comes first
}

ChildProcess::~ChildProcess() {
  if (end_) return;
  ::kill(-id_, SIGKILL);
  while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

std::optional<ChildProcess::End> ChildProcess::Poll() {
  int status = 0;
  if (!end_ && ::waitpid(id_, &status, WNOHANG) == id_) {
    end_ = WIFSIGNALED(status) ? End{0, WTERMSIG(status)} : End{WEXITSTATUS(status), std::nullopt};
  }
  return end_;
}

}  // namespace plumbline
