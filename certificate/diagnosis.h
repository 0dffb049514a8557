#pragma once

#include <functional>
#include <string>
#include <vector>

#include "certificate/certificate.h"

namespace simwright::certificate {

// Certifies one target, without a diagnosis.
Certificate CertifyTarget(const Planner& planner, const PlacedScene& scene, const TargetTask& task,
                          const CertificateOptions& options, const std::filesystem::path& file);

// Finds out why there is no plan for a target: sets verdict, reason, and the blockers of
// `certificate`, whose counts come from the failed search.
void Diagnose(const Planner& planner, const PlacedScene& scene, const TargetTask& task,
              const CertificateOptions& options, Certificate* certificate);

}  // namespace simwright::certificate
