#pragma once

#include <memory>

#include "factory/factory_folder.h"
#include "factory/factory_plan.h"
#include "factory/factory_record.h"
#include "texture/image_generator.h"

namespace simwright::factory {

// Makes one asset of a factory and its texture variants in folder.assets(), and checks them. A
// failed attempt is repeated with another seed, a photo at last in its free form; the record names
// every attempt. `generator`: paints the variants
// for a prompt; may be null. Throws core::Error if the disk is full, and core::Cancelled.
AssetRecord MakeFactoryAsset(const FactoryItem& item, const FactoryFolder& folder,
                             const std::shared_ptr<texture::ImageGenerator>& generator);

// Throws core::Error if less than 200 MB are free on the folder's file system.
void RequireFreeDisk(const std::filesystem::path& folder);

// Returns the processor time of the calling thread, s.
double ThreadSeconds();

}  // namespace simwright::factory
