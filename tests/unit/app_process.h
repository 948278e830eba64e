// Runs the built program as its users do, and says what it answered: exit status, stdout, stderr.
//
// RIDGELINE_PROGRAM is the program's path, set by CMake. Output goes through files, so no pipe can fill up.
#pragma once

#include <doctest/doctest.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "unit/app_folder.h"

namespace ridgeline::test {

struct Answer {
    int status = -1;  // 128 + signal where a signal ended the program
    std::string out;
    std::string err;

    long error_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

// A program that runs; wait() must be called once.
class Process {
  public:
    explicit Process(const std::vector<std::string>& arguments) {
        std::vector<char*> argv = {name_.data()};
        std::vector<std::string> copies = arguments;
        for (std::string& argument : copies) argv.push_back(argument.data());
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, folder_.file("out").c_str(), flags, 0600);
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, folder_.file("err").c_str(), flags, 0600);
        const int failure = posix_spawn(&id_, name_.c_str(), &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        REQUIRE(failure == 0);
    }

    pid_t id() const { return id_; }

    Answer wait() {
        int status = 0;
        REQUIRE(waitpid(id_, &status, 0) == id_);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return {code, file_text(folder_.file("out")), file_text(folder_.file("err"))};
    }

  private:
    Folder folder_;
    std::string name_ = RIDGELINE_PROGRAM;
    pid_t id_ = -1;
};

inline Answer run(const std::vector<std::string>& arguments) { return Process(arguments).wait(); }

// The run is to succeed, and to have nothing to complain of.
inline Answer run_well(const std::vector<std::string>& arguments) {
    Answer answer = run(arguments);
    INFO(arguments.front() << " said: " << answer.err);
    REQUIRE(answer.status == 0);
    CHECK(answer.err.empty());
    return answer;
}

// Wrong usage: status 2 and one line that opens with what was wrong.
inline void check_usage_error(const std::vector<std::string>& arguments, const std::string& what) {
    const Answer answer = run(arguments);
    std::string line = "ridgeline";
    for (const std::string& argument : arguments) line += " " + argument;
    INFO(line << " said: " << answer.err);
    CHECK(answer.status == 2);
    CHECK(answer.out.empty());
    CHECK(answer.error_lines() == 1);
    CHECK(answer.err.starts_with("ridgeline: error: " + what + ": "));
}

// The run failed: status 1 and one line that names `what` somewhere.
inline void check_failure(const std::vector<std::string>& arguments, const std::string& what) {
    const Answer answer = run(arguments);
    std::string line = "ridgeline";
    for (const std::string& argument : arguments) line += " " + argument;
    INFO(line << " said: " << answer.err);
    CHECK(answer.status == 1);
    CHECK(answer.error_lines() == 1);
    CHECK(answer.err.starts_with("ridgeline: error: "));
    CHECK(answer.err.find(what) != std::string::npos);
}

}  // namespace ridgeline::test
