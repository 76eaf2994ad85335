// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/nn/peers.h"

namespace ps::bench {

#ifndef PS_HAVE_ONEDNN
double time_onednn(const ConvolutionCase&) { return 0; }
#endif
#ifndef PS_HAVE_OPENBLAS
Peak peak_of_openblas() { return {"OpenBLAS is not here", 0}; }
#endif

}  // namespace ps::bench
