# The target docs: the API reference of the public headers, by Doxygen, in build/.../docs/html.

find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  return()
endif()
set(DOXYGEN_PROJECT_NAME Taut)
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/docs")
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE README.md)
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_EXCLUDE_SYMBOLS std)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_QUIET YES)
# Every public name is described, or the target fails.
set(DOXYGEN_WARN_IF_UNDOCUMENTED YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
get_property(public_headers GLOBAL PROPERTY TAUT_PUBLIC_HEADERS)
list(TRANSFORM public_headers REPLACE "^taut/" "toolkit/")
doxygen_add_docs(docs README.md toolkit/io/formats.md ${public_headers}
                 WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" COMMENT "Write the API reference")
