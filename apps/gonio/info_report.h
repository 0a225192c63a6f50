// A table's description as people and as programs read it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "table/describe.h"
#include "table/sample_table.h"

namespace gonio::app {

/// At most 100 columns wide, where names and paths allow; ends with a newline.
std::string info_text(const table::SampleTable& table, const table::Description& description);

/// The same and more: every channel, however many.
nlohmann::ordered_json info_json(const table::SampleTable& table,
                                 const table::Description& description);

}  // namespace gonio::app
