# gonio_room(NAME SOURCES .. PUBLIC lib.. PRIVATE lib..): a library gonio::NAME of one folder.
# Every header of the folder is installed, under include/gonio/NAME.
function(gonio_room room)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(gonio_${room} STATIC ${ARG_SOURCES})
  add_library(gonio::${room} ALIAS gonio_${room})
  set_target_properties(gonio_${room} PROPERTIES EXPORT_NAME ${room} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(gonio_${room} PUBLIC cxx_std_20)
  target_include_directories(gonio_${room} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/gonio>)
  # A square root is one instruction where nobody asks for errno.
  target_compile_options(gonio_${room} PRIVATE -fno-math-errno)
  target_link_libraries(gonio_${room} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  gonio_warnings(gonio_${room})
  install(TARGETS gonio_${room} EXPORT gonio-targets)
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gonio/${room} FILES_MATCHING PATTERN "*.h")
endfunction()

function(gonio_warnings target)
  # GCC 12 reports -Wrestrict falsely for "literal" + std::string (GCC bug 105651), and -Wpsabi for
  # vector arguments (brdf/pack.h), which never cross a library's border.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-psabi>
    $<$<BOOL:${GONIO_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()
