// What a process has to be started with for RADV, Mesa's driver for AMD's GPUs, to compile for a
// chip that need not be there (instruction_counts.h): its manifest, and the variable that names the
// chip.
//
// Sources: the Vulkan loader's documentation, "Driver Discovery on Linux"; Mesa's, "Environment
// Variables", RADV_FORCE_FAMILY and, in newer versions, AMD_FORCE_FAMILY.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace gonio::shader {

/// The folders in which the Vulkan loader looks for the manifests of drivers, whether or not they
/// exist.
std::vector<std::filesystem::path> driver_folders();

/// The manifests of RADV (radeon_icd*.json) in the folders, in the order of their names in each.
std::vector<std::filesystem::path> radv_manifests(
    const std::vector<std::filesystem::path>& folders = driver_folders());

/// The variables, as NAME=VALUE, of a process that is to compile for the chip: a family as RADV
/// calls it, such as polaris10, vega10 or navi21. `manifests`: one or more of them, of which those
/// for other processors do not matter.
std::vector<std::string> chip_environment(const std::string& chip,
                                          std::span<const std::filesystem::path> manifests);

}  // namespace gonio::shader
