#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace lobe::test {

/// The real program while it runs; killed at the end if it still does.
class RunningLobe {
 public:
  /// Returns once it has said its first line on standard output, or ended.
  explicit RunningLobe(const std::vector<std::string>& arguments) {
    int out[2];
    if (pipe(out) != 0) throw std::runtime_error("pipe failed");
    std::vector<const char*> argv{LOBE_PROGRAM};
    for (const std::string& a : arguments) argv.push_back(a.c_str());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ < 0) throw std::runtime_error("fork failed");
    if (child_ == 0) {
      dup2(out[1], STDOUT_FILENO);
      close(out[0]);
      close(out[1]);
      execv(LOBE_PROGRAM, const_cast<char**>(argv.data()));
      _exit(127);
    }
    close(out[1]);
    FILE* stream = fdopen(out[0], "r");
    for (int c; (c = std::fgetc(stream)) != EOF && c != '\n';) first_line_ += char(c);
    std::fclose(stream);
  }
  ~RunningLobe() {
    if (child_ < 0) return;
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  RunningLobe(const RunningLobe&) = delete;
  RunningLobe& operator=(const RunningLobe&) = delete;

  const std::string& first_line() const { return first_line_; }

  struct End {
    int exit_code;   ///< 128 + signal if one ended it
    double seconds;  ///< it took
  };
  /// Sends `signal` and waits.
  End Stop(int signal) {
    const auto start = std::chrono::steady_clock::now();
    kill(child_, signal);
    int status = 0;
    while (waitpid(child_, &status, 0) < 0) {
    }
    child_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  }

 private:
  pid_t child_;
  std::string first_line_;
};

}  // namespace lobe::test
