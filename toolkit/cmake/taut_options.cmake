# The target taut_options: what every part of Taut is compiled with.

add_library(taut_options INTERFACE)
target_compile_features(taut_options INTERFACE cxx_std_20)

# "taut/core/error.h" is toolkit/core/error.h.
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/include")
file(CREATE_LINK "${PROJECT_SOURCE_DIR}/toolkit" "${PROJECT_BINARY_DIR}/include/taut" SYMBOLIC)
target_include_directories(taut_options INTERFACE "${PROJECT_BINARY_DIR}/include")

# A product and a sum fused into one rounding would change signs that decide topology.
target_compile_options(taut_options INTERFACE -ffp-contract=off)

if(PROJECT_IS_TOP_LEVEL)
  # In clang -Wconversion would bring in signs, which every index into a vector changes.
  target_compile_options(taut_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion
                                                -Wno-sign-conversion -Wshadow)
  # GCC 12 sees overlaps in "text" + std::string that are not there (its bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(taut_options INTERFACE -Wno-restrict)
  endif()
  # Sources that are compiled together see what the others have in unnamed namespaces.
  if(CMAKE_UNITY_BUILD)
    target_compile_options(taut_options INTERFACE -Wno-shadow -Wno-subobject-linkage)
  endif()
  if(TAUT_WARNINGS_AS_ERRORS)
    target_compile_options(taut_options INTERFACE -Werror)
  endif()
endif()

if(TAUT_SANITIZE)
  target_compile_options(taut_options INTERFACE -fsanitize=${TAUT_SANITIZE} -fno-omit-frame-pointer
                                                -fno-sanitize-recover=all)
  target_link_options(taut_options INTERFACE -fsanitize=${TAUT_SANITIZE})
  # Indices and optionals of the standard library are checked too.
  target_compile_definitions(taut_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()
