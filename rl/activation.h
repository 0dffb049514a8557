#pragma once

namespace simwright::rl {

// The activation between the layers of a network. ELU (Clevert et al. 2016) does not saturate on
// inputs far from 0 and costs no more than tanh.
enum class Activation { kElu, kTanh };

}  // namespace simwright::rl
