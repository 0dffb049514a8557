#include "nn/blas_library.h"

#include <dlfcn.h>

namespace simwright::nn {

std::string BlasLibrary() {
  void* product = dlsym(RTLD_DEFAULT, "sgemm_");
  Dl_info info;
  if (product == nullptr || dladdr(product, &info) == 0 || info.dli_fname == nullptr) return "";
  return info.dli_fname;
}

}  // namespace simwright::nn
