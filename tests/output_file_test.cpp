// Output files: the old content or the new one, never less, whatever happens in between.
#include "table/output_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

#include "table/file_error.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using table::FileError;
using table::OutputFile;
using table::write_file;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(const std::string& path, std::string_view content) {
  try {
    write_file(path, content);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

mode_t permissions(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
  return status.st_mode & 07777;
}

TEST(OutputFile, AppearsOnlyWithCommit) {
  const TemporaryFolder folder;
  const std::string path = folder / "out.csv";
  {
    OutputFile file(path);
    file.write(std::string(3 << 20, 'x'));  // more than any buffer
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  EXPECT_THAT(folder.names(), ElementsAre());
  write_file(path, "content");
  EXPECT_EQ(content_of(path), "content");
  EXPECT_THAT(folder.names(), ElementsAre("out.csv"));
  { OutputFile file(path); }
  EXPECT_EQ(content_of(path), "content");
}

TEST(OutputFile, HasThePermissionsOfTheOldFileOrOfTheUmask) {
  const TemporaryFolder folder;
  const mode_t before = umask(027);
  write_file(folder / "new", "1");
  const std::string old = folder.write("old", "1");
  ASSERT_EQ(chmod(old.c_str(), 0604), 0);
  write_file(old, "2");
  umask(before);
  EXPECT_EQ(permissions(folder / "new"), mode_t{0640});
  EXPECT_EQ(permissions(old), mode_t{0604});
  EXPECT_EQ(content_of(old), "2");
}

TEST(OutputFile, ReplacesTheFileThatALinkNames) {
  const TemporaryFolder folder;
  const std::string target = folder.write("target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  std::filesystem::create_symlink("absent", folder / "dangling");
  write_file(folder / "link", "new");
  write_file(folder / "dangling", "made");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(content_of(target), "new");
  EXPECT_EQ(content_of(folder / "absent"), "made");
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_THAT(refusal(folder / "loop", "x"), HasSubstr("symbolic links"));
}

TEST(OutputFile, WritesPipesDirectly) {
  const TemporaryFolder folder;
  const std::string path = folder / "fifo";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  write_file(path, "through");
  char text[16] = {};
  EXPECT_EQ(read(reader, text, sizeof text), 7);
  close(reader);
  EXPECT_STREQ(text, "through");
  EXPECT_TRUE(std::filesystem::is_fifo(path)) << "still a pipe";
  EXPECT_THAT(folder.names(), ElementsAre("fifo"));
}

TEST(OutputFile, SaysWhatIsWrongWithThePath) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "absent/out.csv", "x"),
              HasSubstr("the folder '" + folder / "absent" + "' does not exist"));
  EXPECT_THAT(refusal(folder / ".", "x"), HasSubstr("this is a folder"));
  EXPECT_THAT(refusal("", "x"), HasSubstr("names no file"));
  const std::string file = folder.write("file", "x");
  EXPECT_THAT(refusal(file + "/out.csv", "x"), HasSubstr("cannot be created in the folder"));
}

TEST(OutputFile, ReportsAFullDevice) {
  EXPECT_THAT(refusal("/dev/full", "x"), HasSubstr("/dev/full: could not be written"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "not replaced";
}

/// Files of this process cannot grow beyond a size, as on a full disk, for the guard's life.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(OutputFile, AFullDiskLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const std::string path = folder.write("out.csv", "old");
  const std::string big(8 << 20, 'x');
  std::string message;
  {
    const FileSizeLimit limit(1 << 20);
    message = refusal(path, big);
  }
  EXPECT_THAT(message, HasSubstr("out.csv: could not be written"));
  EXPECT_THAT(message, HasSubstr("free some space"));
  EXPECT_EQ(content_of(path), "old");
  EXPECT_THAT(folder.names(), ElementsAre("out.csv"));
  write_file(path, big);
  EXPECT_EQ(content_of(path), big) << "the limit is lifted again";
}

TEST(OutputFile, AKilledWriterLeavesTheOldContentOrTheNew) {
  using namespace std::chrono_literals;
  const TemporaryFolder folder;
  const std::string path = folder / "out.csv";
  const std::string contents[2] = {std::string(3 << 20, 'a'), std::string(5 << 20, 'b')};
  write_file(path, contents[0]);
  for (int kill_number = 0; kill_number < 12; ++kill_number) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (int i = 1;; ++i) write_file(path, contents[i % 2]);
    }
    std::this_thread::sleep_for(5ms + kill_number * 3ms);
    ASSERT_EQ(kill(child, SIGKILL), 0);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    const std::string found = content_of(path);
    EXPECT_TRUE(found == contents[0] || found == contents[1]) << found.size() << " bytes";
  }
}

}  // namespace
}  // namespace gonio::tests
