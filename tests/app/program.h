#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace lobe::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal if one ended it
  std::string out, err;
};

struct ProgramOptions {
  /// Files may not grow beyond this, as on a full disk; 0: no limit.
  rlim_t file_size_limit = 0;
  /// Called whenever more has arrived on standard error, with all of it so far.
  std::function<void(pid_t, const std::string& err)> on_stderr;
  /// Called every few milliseconds while it runs.
  std::function<void(pid_t)> on_tick;
  /// SIGKILL, which nothing can catch, so long after the start; 0: never.
  std::chrono::microseconds kill_after{0};
};

/// Runs the real program to its end.
inline ProgramResult RunLobe(const std::vector<std::string>& arguments, const ProgramOptions& options = {}) {
  int out_pipe[2], err_pipe[2];
  if (pipe(out_pipe) != 0 || pipe(err_pipe) != 0) throw std::runtime_error("pipe failed");
  std::vector<const char*> argv{LOBE_PROGRAM};
  for (const std::string& a : arguments) argv.push_back(a.c_str());
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    dup2(out_pipe[1], STDOUT_FILENO);
    dup2(err_pipe[1], STDERR_FILENO);
    for (const int fd : {out_pipe[0], out_pipe[1], err_pipe[0], err_pipe[1]}) close(fd);
    if (options.file_size_limit > 0) {
      const rlimit limit{options.file_size_limit, options.file_size_limit};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(LOBE_PROGRAM, const_cast<char**>(argv.data()));
    _exit(127);
  }
  close(out_pipe[1]);
  close(err_pipe[1]);

  const auto start = std::chrono::steady_clock::now();
  bool killed = false;
  ProgramResult result;
  pollfd polls[2] = {{out_pipe[0], POLLIN, 0}, {err_pipe[0], POLLIN, 0}};
  std::string* texts[2] = {&result.out, &result.err};
  for (int open_pipes = 2; open_pipes > 0;) {
    const auto age =
        std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
    const bool kill_to_come = options.kill_after.count() > 0 && !killed;
    if (kill_to_come && age >= options.kill_after) {
      kill(child, SIGKILL);
      killed = true;
      continue;
    }
    if (options.on_tick) options.on_tick(child);
    const int64_t until_kill = kill_to_come ? (options.kill_after - age).count() : 10'000'000;
    const int64_t pause = std::min<int64_t>(options.on_tick ? 3000 : 10'000'000, until_kill);
    const timespec wait{pause / 1'000'000, pause % 1'000'000 * 1000};
    if (ppoll(polls, 2, &wait, nullptr) < 0) continue;
    for (int i = 0; i < 2; ++i) {
      if (polls[i].fd < 0 || polls[i].revents == 0) continue;
      char buffer[4096];
      const ssize_t n = read(polls[i].fd, buffer, sizeof buffer);
      if (n > 0) {
        texts[i]->append(buffer, size_t(n));
        if (i == 1 && options.on_stderr) options.on_stderr(child, result.err);
      } else {
        close(polls[i].fd);
        polls[i].fd = -1;
        --open_pipes;
      }
    }
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
  }
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

inline ProgramResult RunQuietly(std::vector<std::string> arguments, const ProgramOptions& options = {}) {
  arguments.push_back("--quiet");
  return RunLobe(arguments, options);
}

/// A failure: this exit code, nothing on standard output, and on standard error exactly one line, which
/// begins with "lobe: " and contains every one of `parts`.
inline void ExpectOneSentence(const ProgramResult& r, int exit_code, const std::vector<std::string>& parts) {
  EXPECT_EQ(r.exit_code, exit_code) << r.err;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(r.err.rfind("lobe: ", 0), 0u) << r.err;
  EXPECT_FALSE(r.err.empty());
  EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << "one line: " << r.err;
  for (const std::string& part : parts) {
    EXPECT_NE(r.err.find(part), std::string::npos) << "expected '" << part << "' in: " << r.err;
  }
}

inline std::string ScenePath(const std::string& name) {
  return std::string(LOBE_TEST_DATA) + "/scenes/" + name + ".glb";
}

/// Solves one of the test scenes coarsely: a second at most.
inline void SolveCoarsely(const std::string& scene, const std::string& output) {
  const ProgramResult r = RunQuietly({"solve", ScenePath(scene), "-o", output, "--edge", "2", "--lmax", "5",
                                      "--light-samples", "4", "--delta-areas", "16"});
  ASSERT_EQ(r.exit_code, 0) << r.err;
}

}  // namespace lobe::test
