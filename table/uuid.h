// Name-based UUIDs: the same name, the same identifier.
//
// Source: RFC 9562, section 5.5 (version 5, SHA-1), in the namespace for URLs of its table 6.
#pragma once

#include <string>
#include <string_view>

namespace gonio::table {

/// The version 5 UUID of `name`, which is to be a URL or URN, in lower case:
/// "xxxxxxxx-xxxx-5xxx-..".
std::string url_uuid(std::string_view name);

}  // namespace gonio::table
