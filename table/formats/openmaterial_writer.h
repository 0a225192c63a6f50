// Writing ASAM OpenMATERIAL 3D BRDF tables (.xompt); openmaterial.h describes them.
//
// Source: ASAM OpenMATERIAL 3D 1.0.0, material_brdf_schema.json and the checker rules of annex A.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "table/sample_table.h"

namespace gonio::table {

/// What the format demands and a table does not know; NOASSERTION is what SPDX says for unknown.
struct OpenMaterialMetadata {
  std::string name{};                   // empty: the table's
  std::string description{};            // empty: what the table is, and what was lost
  std::string license = "NOASSERTION";  // an SPDX identifier, a URL or a file
  std::string copyright = "NOASSERTION";
  std::string author = "unknown";
  std::string sources{};  // empty: the table's file
};

/// What the format has no room for.
struct OpenMaterialLoss {
  std::size_t masked = 0;          // samples left out
  std::size_t at_horizon = 0;      // samples left out: a zenith of 1.570796 or more
  std::size_t holes = 0;           // values left out of samples with others
  std::size_t negative = 0;        // values written as 0
  std::size_t averaged = 0;        // samples that share their angles with others ..
  std::size_t averages = 0;        // .. and became so many
  std::size_t moved_azimuths = 0;  // samples
  bool light_azimuths = false;     // not all 0
  bool sigma = false;
  bool weights = false;
  std::vector<std::string> renamed;  // channels that are read back under another name
};

/// The loss, a sentence each.
std::vector<std::string> describe(const OpenMaterialLoss& loss);

/// Writes the samples at the azimuth of wo from wi, those of the same angles (to 1e-14) averaged,
/// sorted as the standard demands. Channels are wavelengths, or R, G and B, which are written as
/// 611.4, 549.1 and 464.3 nm; a single channel of another name has the wavelength null. Values read
/// back to the same bits. The same table gives the same bytes; its UUID is made from its numbers
/// and name. `write` gets the text in pieces. Throws FileError for channels that are no
/// wavelengths, or the same one, or beyond 1 nm to 17.16 mm, and where no sample is left.
OpenMaterialLoss write_openmaterial(const SampleTable& table, const OpenMaterialMetadata& metadata,
                                    const std::function<void(std::string_view)>& write);

/// The address of a schema of the standard, "material_brdf_schema".
std::string openmaterial_schema_url(std::string_view schema);

/// The member "metadata"; without "sources" if those are empty.
nlohmann::ordered_json openmaterial_metadata(const OpenMaterialMetadata& metadata,
                                             const std::string& uuid);

}  // namespace gonio::table
