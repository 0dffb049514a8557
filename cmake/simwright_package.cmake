# `cpack` in the build folder makes simwright_VERSION_ARCHITECTURE.deb for Debian 12; ./package.sh does all
# of it. The package has the program with its manual pages and completions, the static libraries with
# their public headers, the weights, the examples, and the Python module if SIMWRIGHT_PYTHON is on.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME simwright)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_VENDOR "Simwright")
set(CPACK_PACKAGE_CONTACT "The Simwright developers <simwright@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "photos and meshes to simulation-ready assets, tasks and scenes")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Simwright turns photos and meshes into simulation-ready assets, assets into
robot tasks and cluttered scenes, tasks into trained skills, and skills into
trajectories for a real arm. It runs offline on two CPU cores.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/prerm)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)  # a fifth of the time of xz
# Shared libraries are found by dpkg-shlibdeps. OpenBLAS is named because any BLAS would satisfy it,
# WordNet because the program reads its files.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libopenblas0-pthread, wordnet-base")
if(SIMWRIGHT_PYTHON)
  execute_process(COMMAND ${Python_EXECUTABLE} -c
    "import sys; print('python3 (>= %d.%d), python3 (<< %d.%d)' % (*sys.version_info[:2], sys.version_info[0], sys.version_info[1] + 1))"
    OUTPUT_VARIABLE simwright_python_range OUTPUT_STRIP_TRAILING_WHITESPACE)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", ${simwright_python_range}, python3-numpy")
endif()
# What a program that links the libraries is compiled with, and what starts several ranks.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "g++, cmake, libassimp-dev, libbullet-dev, libceres-dev, libcgal-dev, libcpp-httplib-dev, libcurl4-openssl-dev, \
libdraco-dev, libeigen3-dev, libembree-dev, libexif-dev, libgif-dev, libhdf5-dev, libmujoco-dev, \
libopencv-contrib-dev, libopencv-dev, libopenmpi-dev, libspdlog-dev, libtinyxml2-dev, libtorch-dev, \
liburdfdom-dev, libwebp-dev, libzip-dev, nlohmann-json3-dev, openmpi-bin, python3-h5py")

set(simwright_package_files ${CMAKE_BINARY_DIR}/package_files)
# Manual pages and completions, made by the program itself when the package is made.
add_custom_target(simwright_package_files
  COMMAND ${PROJECT_SOURCE_DIR}/packaging/package_files.sh $<TARGET_FILE:simwright> ${PROJECT_SOURCE_DIR}
          ${simwright_package_files}
  DEPENDS simwright
  VERBATIM)
install(DIRECTORY ${simwright_package_files}/share DESTINATION . COMPONENT package EXCLUDE_FROM_ALL)
install(FILES LICENSE README.md DESTINATION share/doc/simwright COMPONENT package EXCLUDE_FROM_ALL)
install(DIRECTORY examples DESTINATION share/doc/simwright COMPONENT package EXCLUDE_FROM_ALL)

set(CPACK_INSTALL_CMAKE_PROJECTS
    "${CMAKE_BINARY_DIR};simwright;Unspecified;/"
    "${CMAKE_BINARY_DIR};simwright;package;/")
if(SIMWRIGHT_PYTHON)
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS
       "${CMAKE_BINARY_DIR};simwright;package_python;/")
endif()
include(CPack)
