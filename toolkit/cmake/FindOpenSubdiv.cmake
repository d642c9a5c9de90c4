# Finds OpenSubdiv's CPU library and defines OpenSubdiv::osdCPU.
#
# Debian's package configuration cannot be used: it refers to a static library that libosd-dev does
# not ship, and stops even where the package is optional.

find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/version.h)
find_library(OpenSubdiv_CPU_LIBRARY NAMES osdCPU)
mark_as_advanced(OpenSubdiv_INCLUDE_DIR OpenSubdiv_CPU_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv REQUIRED_VARS OpenSubdiv_CPU_LIBRARY
                                                           OpenSubdiv_INCLUDE_DIR)

if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
  add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
  set_target_properties(
    OpenSubdiv::osdCPU PROPERTIES IMPORTED_LOCATION "${OpenSubdiv_CPU_LIBRARY}"
                                  INTERFACE_INCLUDE_DIRECTORIES "${OpenSubdiv_INCLUDE_DIR}")
endif()
