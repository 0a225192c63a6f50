// Finding RADV and naming a chip to it (shader/chip_environment.h).
#include "shader/chip_environment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "tests/run_gonio.h"

namespace gonio::tests {
namespace {

TEST(ChipEnvironment, FindsTheManifestsOfRadvAlone) {
  const TemporaryFolder folder;
  const TemporaryFolder other;
  const std::vector<std::filesystem::path> manifests{folder.write("radeon_icd.i686.json", ""),
                                                     folder.write("radeon_icd.x86_64.json", ""),
                                                     other.write("radeon_icd.json", "")};
  (void)folder.write("lvp_icd.x86_64.json", "");
  (void)folder.write("radeon_icd.x86_64.json.old", "");
  EXPECT_EQ(shader::radv_manifests({folder / "", folder / "none", other / ""}), manifests);
}

TEST(ChipEnvironment, NamesTheChipAndTheDriverForEveryVersionOfMesaAndOfTheLoader) {
  const std::vector<std::filesystem::path> manifests{"/a.json", "/b.json"};
  EXPECT_THAT(
      shader::chip_environment("navi21", manifests),
      testing::IsSupersetOf({"VK_DRIVER_FILES=/a.json:/b.json", "VK_ICD_FILENAMES=/a.json:/b.json",
                             "RADV_FORCE_FAMILY=navi21", "AMD_FORCE_FAMILY=navi21"}));
}

}  // namespace
}  // namespace gonio::tests
