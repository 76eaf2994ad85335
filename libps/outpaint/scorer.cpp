// SPDX-License-Identifier: BSD-3-Clause
#include "libps/outpaint/scorer.h"

#include <vector>

#include "libps/outpaint/selection.h"

namespace ps::outpaint {

Scorer discriminator_scorer(const models::Discriminator& network) {
  return {"discriminator", true, [&](const nn::TensorView& image, nn::Workspace& workspace) {
            float score = 0;
            network.score(image, &score, workspace);
            return static_cast<double>(score);
          }};
}

Scorer entropy_scorer(const models::Classifier& network) {
  return {"entropy", false, [&](const nn::TensorView& image, nn::Workspace& workspace) {
            const nn::Workspace::Scope scope(workspace);
            const nn::TensorView normal = workspace.take(image.shape);
            models::Classifier::normalise(image, normal);
            std::vector<float> logits(static_cast<std::size_t>(network.classes()));
            network.forward(normal, {logits.data(), {1, 1, 1, network.classes()}, logits.size()},
                            workspace);
            return entropy(logits);
          }};
}

}  // namespace ps::outpaint
