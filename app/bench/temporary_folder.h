// A folder that goes with the object.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace ridgeline::app {

class TemporaryFolder {
  public:
    // Where it cannot be made, what is put into it fails.
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "ridgeline-bench-XXXXXX").string();
        const char* made = ::mkdtemp(name.data());
        path_ = made ? std::string(made) : name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace ridgeline::app
