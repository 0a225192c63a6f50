// Input files: what is no table, pipes, and the digest of a file.
#include "table/read.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <string>

#include "table/file_error.h"
#include "tests/gonio_csv_text.h"
#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Read, RefusesWhatIsNoTable) {
  const auto refusal_of_path = [](const std::string& path) -> std::string {
    try {
      table::read(path);
    } catch (const table::FileError& error) {
      return error.what();
    }
    return "accepted";
  };
  const TemporaryFolder folder;
  EXPECT_EQ(refusal_of_path(folder / "absent.csv"),
            folder / "absent.csv" + ": no such file: check the path");
  EXPECT_THAT(refusal_of_path(folder / ""), HasSubstr("this is a folder"));
  EXPECT_THAT(refusal_of_path(folder.write("empty.csv", "")), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal_of_path(folder.write("file", "1") + "/below"),
              testing::AnyOf(HasSubstr("no such file"), HasSubstr("cannot be read")));
  EXPECT_THAT(refusal_of_path("/dev/null"), HasSubstr("this is a device"));
  EXPECT_THAT(refusal_of_path(folder.write("junk", std::string("\x7f"
                                                               "ELF\x02\0\x01\0",
                                                               8))),
              AllOf(HasSubstr("binary data"), HasSubstr("gonio-table"), HasSubstr("ASTM")));
  EXPECT_THAT(refusal_of_path(folder.write("utf16", "\xFF\xFE#\n")), HasSubstr("save it as UTF-8"));
  EXPECT_THAT(refusal_of_path(folder.write("prose", "Dear sirs,\nplease find attached\n")),
              AllOf(HasSubstr("gonio-table"), HasSubstr("ASTM")));
}

TEST(Read, TakesAPipe) {
  const TemporaryFolder folder;
  const std::string path = folder.write("table.csv", plain + "10,0,20,0,1,2\n");
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const std::string text = content_of(path);
  ASSERT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  close(ends[1]);
  const std::string pipe_path = fmt::format("/dev/fd/{}", ends[0]);
  EXPECT_EQ(table::read(pipe_path).size(), 1u);
  EXPECT_EQ(table::sha256_of_file(pipe_path), "") << "its bytes are gone";
  close(ends[0]);
}

TEST(Read, GivesTheSha256OfAFile) {
  const TemporaryFolder folder;
  // FIPS 180-2, appendix B.1: the digest of "abc".
  EXPECT_EQ(table::sha256_of_file(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_THROW(table::sha256_of_file(folder / "absent"), table::FileError);
}

}  // namespace
}  // namespace gonio::tests
