# All dependencies are from Debian 12; docs/dependencies.md gives the purpose of each.
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})

# simwright_pkg(LINK MODULE...): a package that only pkg-config knows, as the target PkgConfig::NAME.
macro(simwright_pkg link)
  find_package(PkgConfig REQUIRED)
  string(REPLACE "PkgConfig::" "" _simwright_name "${link}")
  pkg_check_modules(${_simwright_name} REQUIRED IMPORTED_TARGET ${ARGN})
endmacro()

# Debian's mujocoConfig names an include folder of a package that it does not depend on.
macro(simwright_require_mujoco)
  find_library(MUJOCO_LIBRARY mujoco REQUIRED)
  find_path(MUJOCO_HEADER mujoco/mujoco.h)
  if(NOT TARGET mujoco::mujoco)
    add_library(mujoco::mujoco UNKNOWN IMPORTED)
    set_target_properties(mujoco::mujoco PROPERTIES IMPORTED_LOCATION ${MUJOCO_LIBRARY})
  endif()
endmacro()

# simwright_find_cuda_headers(FOLDER): sets `simwright_cuda_headers` to the include folders of CUDA
# below FOLDER, which holds Nvidia's packages for Python; to nothing where one is missing. PyTorch
# depends on nvidia-cuda-runtime; nvidia-cuda-crt has the rest.
macro(simwright_find_cuda_headers folder)
  set(simwright_cuda_headers)
  foreach(header cuda_runtime_api.h crt/host_config.h)
    file(GLOB _simwright_found ${folder}/*/include/${header})
    if(_simwright_found)
      list(GET _simwright_found 0 _simwright_found)
      string(REPLACE "/${header}" "" _simwright_found ${_simwright_found})
      list(APPEND simwright_cuda_headers ${_simwright_found})
    else()
      message(STATUS "No CUDA graphs: ${header} is missing (Python's package nvidia-cuda-crt)")
      set(simwright_cuda_headers)
      break()
    endif()
  endforeach()
endmacro()

# SIMWRIGHT_TORCH_ROOT: the folder of another libtorch, with include/ and lib/, such as that of a
# Python package with CUDA. Its own CMake config is not read, since that needs the CUDA toolkit. The
# library of CUDA registers itself when it is loaded: nothing names it, so the linker must keep it.
set(SIMWRIGHT_TORCH_ROOT "" CACHE PATH "Folder of a libtorch to use in place of Debian's")
macro(simwright_require_torch_of root)
  if(NOT TARGET simwright_torch)
    file(GLOB simwright_torch_cuda ${root}/lib/libtorch_cuda.so)
    file(GLOB simwright_c10_cuda ${root}/lib/libc10_cuda.so)
    file(GLOB simwright_cudart ${root}/../nvidia/*/lib/libcudart.so.*)
    if(simwright_cudart)
      list(GET simwright_cudart -1 simwright_cudart)  # of several versions the newest
    endif()
    simwright_find_cuda_headers(${root}/../nvidia)
    if(simwright_cuda_headers AND simwright_c10_cuda AND simwright_cudart)
      get_filename_component(simwright_cudart_folder ${simwright_cudart} DIRECTORY)
      set(simwright_cuda_links ${simwright_c10_cuda} ${simwright_cudart})
      set(simwright_cuda_rpath LINKER:-rpath,${simwright_cudart_folder})
    else()
      set(simwright_cuda_headers)
      set(simwright_cuda_links)
      set(simwright_cuda_rpath)
    endif()
    set(simwright_torch_kept ${root}/lib/libtorch_cpu.so ${simwright_torch_cuda})
    list(JOIN simwright_torch_kept "," simwright_torch_kept)
    add_library(simwright_torch INTERFACE IMPORTED)
    target_include_directories(simwright_torch SYSTEM INTERFACE
      ${root}/include ${root}/include/torch/csrc/api/include)
    target_link_options(simwright_torch INTERFACE
      "LINKER:--no-as-needed,${simwright_torch_kept},--as-needed" LINKER:--allow-shlib-undefined
      LINKER:-rpath,${root}/lib ${simwright_cuda_rpath})
    target_link_libraries(simwright_torch INTERFACE
      ${root}/lib/libtorch_cpu.so ${root}/lib/libc10.so ${simwright_cuda_links})
  endif()
endmacro()

# Debian's Torch config provides the headers and libraries as variables; they become one target.
macro(simwright_require_torch)
  find_package(Torch REQUIRED)
  # Torch defines _GLIBCXX_USE_CXX11_ABI=1, which is the default; modules without libtorch can share
  # precompiled headers only if all definitions are equal.
  set_property(TARGET torch PROPERTY INTERFACE_COMPILE_OPTIONS)
  if(NOT TARGET simwright_torch)
    add_library(simwright_torch INTERFACE IMPORTED)
    target_link_libraries(simwright_torch INTERFACE ${TORCH_LIBRARIES})
    target_include_directories(simwright_torch SYSTEM INTERFACE ${TORCH_INCLUDE_DIRS})
    # Debian's Ceres depends on ATLAS. The BLAS that a program names first serves all its libraries,
    # and libtorch's convolutions are several times slower on ATLAS: OpenBLAS comes first.
    find_library(SIMWRIGHT_OPENBLAS NAMES libopenblas.so.0 PATH_SUFFIXES openblas-pthread)
    if(SIMWRIGHT_OPENBLAS)
      target_link_options(simwright_torch INTERFACE
        "LINKER:--no-as-needed,${SIMWRIGHT_OPENBLAS},--as-needed")
    else()
      message(WARNING "OpenBLAS is missing (libopenblas0-pthread): networks will be slow")
    endif()
  endif()
endmacro()

# spdlog's target brings compile definitions, and modules can share precompiled headers only if all
# definitions are equal: this one only links it.
macro(simwright_require_spdlog)
  find_package(spdlog REQUIRED)
  if(NOT TARGET simwright_spdlog)
    add_library(simwright_spdlog INTERFACE IMPORTED)
    set_property(TARGET simwright_spdlog PROPERTY
      INTERFACE_LINK_LIBRARIES $<LINK_ONLY:spdlog::spdlog>)
  endif()
endmacro()

# The definitions of cpp-httplib's package belong to the one source that includes it
# (viewer/CMakeLists.txt), for the same reason.
macro(simwright_require_cpp_httplib)
  simwright_pkg(PkgConfig::cpp_httplib cpp-httplib)
  if(NOT TARGET simwright_cpp_httplib)
    add_library(simwright_cpp_httplib INTERFACE IMPORTED)
    set_property(TARGET simwright_cpp_httplib PROPERTY
      INTERFACE_LINK_LIBRARIES $<LINK_ONLY:PkgConfig::cpp_httplib>)
  endif()
endmacro()

# simwright_find_mpi(): sets `simwright_mpi_link` to MPI's target as SIMWRIGHT_MPI says, which is AUTO
# (if there is an MPI), ON or OFF.
macro(simwright_find_mpi)
  set(simwright_mpi_link)
  if(SIMWRIGHT_MPI STREQUAL "AUTO")
    find_package(MPI QUIET COMPONENTS C)
  elseif(SIMWRIGHT_MPI)
    find_package(MPI REQUIRED COMPONENTS C)
  endif()
  if(SIMWRIGHT_MPI AND MPI_C_FOUND)
    set(simwright_mpi_link MPI::MPI_C)
  endif()
endmacro()

# simwright_require(LINK): finds the package that provides what a module links as LINK.
macro(simwright_require link)
  if("${link}" STREQUAL "Threads::Threads")
    find_package(Threads REQUIRED)
  elseif("${link}" STREQUAL "Eigen3::Eigen")
    find_package(Eigen3 REQUIRED NO_MODULE)
  elseif("${link}" STREQUAL "nlohmann_json::nlohmann_json")
    find_package(nlohmann_json REQUIRED)
  elseif("${link}" MATCHES "^opencv_")
    find_package(OpenCV REQUIRED COMPONENTS core dnn imgproc imgcodecs saliency ximgproc calib3d
                 features2d aruco video videoio)
  elseif("${link}" STREQUAL "Ceres::ceres")
    find_package(Ceres REQUIRED)
  elseif("${link}" STREQUAL "CGAL::CGAL")
    find_package(CGAL REQUIRED)
  elseif("${link}" STREQUAL "embree")
    find_package(embree 3 REQUIRED)
  elseif("${link}" STREQUAL "assimp::assimp")
    find_package(assimp REQUIRED)
  elseif("${link}" STREQUAL "mujoco::mujoco")
    simwright_require_mujoco()
  elseif("${link}" STREQUAL "CURL::libcurl")
    find_package(CURL REQUIRED)
  elseif("${link}" STREQUAL "MPI::MPI_C")
    find_package(MPI REQUIRED COMPONENTS C)
  elseif("${link}" STREQUAL "GIF::GIF")
    find_package(GIF REQUIRED)
  elseif("${link}" STREQUAL "simwright_torch" AND SIMWRIGHT_TORCH_ROOT)
    simwright_require_torch_of("${SIMWRIGHT_TORCH_ROOT}")
  elseif("${link}" STREQUAL "simwright_torch")
    simwright_require_torch()
  elseif("${link}" STREQUAL "simwright_spdlog")
    simwright_require_spdlog()
  elseif("${link}" STREQUAL "simwright_cpp_httplib")
    simwright_require_cpp_httplib()
  elseif("${link}" STREQUAL "PkgConfig::bullet")
    simwright_pkg("${link}" bullet-float64)
  elseif("${link}" STREQUAL "PkgConfig::exif")
    simwright_pkg("${link}" libexif)
  elseif("${link}" STREQUAL "PkgConfig::webpdemux")
    simwright_pkg("${link}" libwebpdemux libwebp)
  elseif("${link}" STREQUAL "PkgConfig::hdf5")
    simwright_pkg("${link}" hdf5-serial)
  elseif("${link}" MATCHES "^PkgConfig::(draco|urdfdom|tinyxml2|libzip)$")
    simwright_pkg("${link}" ${CMAKE_MATCH_1})
  endif()
endmacro()
