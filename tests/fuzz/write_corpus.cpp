// Writes the small tables as seed corpora: FOLDER/FORMAT/FILE. CUReT's pair becomes one file, as
// fuzz_reader.cpp takes it.
#include <cstdio>
#include <filesystem>
#include <string>

#include "table/output_file.h"
#include "tests/small_tables.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: write_corpus FOLDER\n");
    return 2;
  }
  std::string pair;
  for (const auto& table : gonio::tests::small_tables()) {
    const std::filesystem::path folder = std::filesystem::path(argv[1]) / table.format;
    std::filesystem::create_directories(folder);
    if (table.format == "curet") {
      pair += pair.empty() ? table.bytes + "=\n" : table.bytes;
      gonio::table::write_file((folder / "pair").string(), pair);
    } else {
      gonio::table::write_file((folder / table.file).string(), table.bytes);
    }
  }
  return 0;
}
