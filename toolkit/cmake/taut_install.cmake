# What Taut installs: the layers, find_package(taut) and taut.pc. The components of the installation
# are the Debian packages: taut (the command), libtaut (shared libraries) and libtaut-dev.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# taut_layer(NAME PUBLIC_HEADERS file... [DEPENDS package...] [STATIC_DEPENDS package...]) says how
# the library taut_NAME is used from elsewhere. Layers are told in their order.
#
# PUBLIC_HEADERS  those that are installed; they include no other header of the toolkit
# DEPENDS         packages, as for find_package, whose headers the public headers include
# STATIC_DEPENDS  those that only the sources use; who links static libraries must find them
function(taut_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "PUBLIC_HEADERS;DEPENDS;STATIC_DEPENDS")
  set(target taut_${name})
  set(packages ${arg_DEPENDS})
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND packages ${arg_STATIC_DEPENDS})
    set_property(GLOBAL APPEND PROPERTY TAUT_STATIC_PACKAGES ${arg_STATIC_DEPENDS})
  endif()
  set_property(GLOBAL APPEND PROPERTY TAUT_LAYERS ${name})
  set_property(GLOBAL PROPERTY TAUT_PACKAGES_${name} ${packages})
  foreach(header IN LISTS arg_PUBLIC_HEADERS)
    set_property(GLOBAL APPEND PROPERTY TAUT_PUBLIC_HEADERS taut/${name}/${header})
  endforeach()

  list(TRANSFORM arg_PUBLIC_HEADERS PREPEND "${PROJECT_BINARY_DIR}/include/taut/${name}/")
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_BINARY_DIR}/include"
                                  FILES ${arg_PUBLIC_HEADERS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  # Inline functions must give the same signs where a user of the library compiles them.
  target_compile_options(${target} INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)
  # While the version is 0.x every minor version may change the binary interface.
  set_target_properties(
    ${target}
    PROPERTIES EXPORT_NAME ${name}
               VERSION ${PROJECT_VERSION}
               SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
               INSTALL_RPATH "${TAUT_LIBRARY_RPATH}")
  if(BUILD_SHARED_LIBS AND LINUX AND NOT TAUT_SANITIZE)
    # Functions of the library stay its own where a program defines an inline one anew.
    target_link_options(${target} PRIVATE LINKER:--no-undefined,-Bsymbolic-functions)
  endif()
  if(TAUT_INSTALL)
    install(
      TARGETS ${target}
      EXPORT taut-targets
      LIBRARY COMPONENT libtaut NAMELINK_COMPONENT libtaut-dev
      ARCHIVE COMPONENT libtaut-dev
      FILE_SET HEADERS COMPONENT libtaut-dev)
  endif()
endfunction()

# Installs what finds the layers: taut-config.cmake and taut.pc.
function(taut_install_configuration)
  set(folder "${PROJECT_BINARY_DIR}/installed")
  set(destination "${CMAKE_INSTALL_LIBDIR}/cmake/taut")
  get_property(layers GLOBAL PROPERTY TAUT_LAYERS)

  set(layer_packages)
  set(libraries)
  foreach(layer IN LISTS layers)
    get_property(packages GLOBAL PROPERTY TAUT_PACKAGES_${layer})
    list(JOIN packages " " packages)
    string(STRIP "_taut_packages_${layer} ${packages}" packages)
    string(APPEND layer_packages "set(${packages})\n")
    string(PREPEND libraries " -ltaut_${layer}")
  endforeach()
  list(JOIN layers " " layers)
  configure_package_config_file(
    "${PROJECT_SOURCE_DIR}/toolkit/cmake/taut-config.cmake.in" "${folder}/taut-config.cmake"
    INSTALL_DESTINATION "${destination}" NO_SET_AND_CHECK_MACRO)
  # As with SOVERSION: 0.2 may break what was built on 0.1.
  write_basic_package_version_file("${folder}/taut-config-version.cmake"
                                   COMPATIBILITY SameMinorVersion)
  install(FILES "${folder}/taut-config.cmake" "${folder}/taut-config-version.cmake"
          DESTINATION "${destination}" COMPONENT libtaut-dev)
  install(EXPORT taut-targets NAMESPACE taut:: DESTINATION "${destination}"
          COMPONENT libtaut-dev)

  # What static libraries need, in the words of pkg-config.
  set(pc_TBB Requires.private tbb)
  set(pc_OpenSubdiv Libs.private -losdCPU)
  set(pc_embree Libs.private -lembree3)
  set(pc_PNG Requires.private libpng)
  set(pc_pugixml Requires.private pugixml)
  set(pc_ZLIB Requires.private zlib)
  set(pc_Requires.private)
  set(pc_Libs.private)
  get_property(static_packages GLOBAL PROPERTY TAUT_STATIC_PACKAGES)
  foreach(package IN LISTS static_packages)
    if(NOT DEFINED pc_${package})
      message(FATAL_ERROR "taut.pc: how does pkg-config find ${package}?")
    endif()
    list(GET pc_${package} 0 field)
    list(GET pc_${package} 1 word)
    string(APPEND pc_${field} " ${word}")
  endforeach()
  if(OpenSubdiv IN_LIST static_packages)
    install(FILES "${PROJECT_SOURCE_DIR}/toolkit/cmake/FindOpenSubdiv.cmake"
            DESTINATION "${destination}" COMPONENT libtaut-dev)
  endif()
  set(pc_folder "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig")
  file(RELATIVE_PATH prefix_from_pc "${pc_folder}" "${CMAKE_INSTALL_PREFIX}")
  string(REGEX REPLACE "/$" "" prefix_from_pc "${prefix_from_pc}")
  configure_file("${PROJECT_SOURCE_DIR}/toolkit/cmake/taut.pc.in" "${folder}/taut.pc" @ONLY)
  install(FILES "${folder}/taut.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
          COMPONENT libtaut-dev)
endfunction()

# Where the installed command and libraries look for the libraries: nowhere of their own if the
# system's linker looks there anyway.
set(TAUT_COMMAND_RPATH "")
set(TAUT_LIBRARY_RPATH "")
if(NOT CMAKE_INSTALL_FULL_LIBDIR IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
  file(RELATIVE_PATH taut_lib_from_bin "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set(TAUT_COMMAND_RPATH "$ORIGIN/${taut_lib_from_bin}")
  set(TAUT_LIBRARY_RPATH "$ORIGIN")
endif()
