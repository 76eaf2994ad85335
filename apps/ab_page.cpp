// SPDX-License-Identifier: BSD-3-Clause
#include "apps/ab_page.h"

#include <map>

#include "apps/page_head.h"
#include "apps/report.h"

namespace ps::apps {
namespace {

constexpr char kStyle[] =
    R"css(  body { margin: 0; padding: 1rem; background: #777; color: #fff; font: 1rem sans-serif; text-align: center; }
  #pictures { display: flex; justify-content: center; gap: 2rem; }
  #pictures button { flex: 0 1 45vw; padding: .5rem; border: 2px solid #999; background: none; color: inherit; font: inherit; }
  #pictures button:hover, #pictures button:focus { border-color: #fff; outline: none; }
  #pictures img { display: block; width: 100%; height: 62vh; object-fit: contain; margin-bottom: .5rem; }
  #input { margin: 0 0 .5rem; }
  #input img { height: 22vh; }
  #input:not([hidden]) + #pictures img { height: 38vh; }
  h1, p { margin: .5rem; }
  progress { width: 50vw; }
  pre { max-height: 60vh; overflow: auto; padding: 1rem; background: #333; text-align: left; }
  a { color: #fff; }
  [hidden] { display: none !important; }
)css";

constexpr char kBody[] = R"html(<main id="study">
<h1 id="question"></h1>
<p>Press <b>1</b> for the left picture, <b>2</b> for the right one, or click on it. If you cannot tell, guess.</p>
<figure id="input" hidden><img alt="input"><figcaption>Both were made of this photo.</figcaption></figure>
<div id="pictures">
<button id="left" type="button"><img alt="left picture">1</button>
<button id="right" type="button"><img alt="right picture">2</button>
</div>
<p><progress id="progress" value="0"></progress> <span id="count"></span></p>
</main>
<section id="end" hidden>
<h1>Thank you. That was all.</h1>
<p>Please send back <a id="download" download="result.json">this file, result.json</a>. It holds:</p>
<pre id="result"></pre>
</section>
<script type="application/json" id="data">)html";

/// `study` is what html_of() writes into the page. The page never says whose a picture is before
/// the end, and names nothing.
constexpr char kScript[] = R"html(</script>
<script>
'use strict';
(() => {
  const study = JSON.parse(document.getElementById('data').textContent);
  const element = id => document.getElementById(id);
  const started = new Date();
  const answers = [];
  let shownAt = 0;

  const show = () => {
    const trial = study.trials[answers.length];
    element('left').querySelector('img').src = study.images[trial.left_image];
    element('right').querySelector('img').src = study.images[trial.right_image];
    element('input').hidden = trial.input_image === undefined;
    if (trial.input_image !== undefined) {
      element('input').querySelector('img').src = study.images[trial.input_image];
    }
    element('progress').max = study.trials.length;
    element('progress').value = answers.length;
    element('count').textContent = `${answers.length + 1} of ${study.trials.length}`;
    shownAt = performance.now();
  };

  // 95 % interval of a share (Wilson, 1927).
  const interval = (wins, count) => {
    if (count === 0) return [null, null];
    const z = 1.96, p = wins / count, n = count;
    const middle = p + z * z / (2 * n), width = z * Math.sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return [(middle - width) / (1 + z * z / n), (middle + width) / (1 + z * z / n)];
  };

  const summary = () => {
    const votes = new Map();
    let sentinels = 0, right = 0, left = 0;
    for (const answer of answers) {
      left += answer.side === 'left' ? 1 : 0;
      if (answer.sentinel) {
        ++sentinels;
        right += answer.choice === 'sound' ? 1 : 0;
      } else {
        votes.set(answer.pair, [...(votes.get(answer.pair) || []), answer.choice]);
      }
    }
    const counts = {a: 0, b: 0, disagree: 0};
    for (const [first, second] of votes.values()) ++counts[first === second ? first : 'disagree'];
    const agreed = counts.a + counts.b, [low, high] = interval(counts.a, agreed);
    return {
      pairs: votes.size, a_wins: counts.a, b_wins: counts.b, votes_disagree: counts.disagree,
      a_share: agreed > 0 ? counts.a / agreed : null, a_share_low: low, a_share_high: high,
      sentinels, sentinels_right: right, left_chosen: left, trials: answers.length,
    };
  };

  const finish = () => {
    const result = {
      program: 'pixelsynth eval ab', version: study.version, a: study.a, b: study.b,
      question: study.question, seed: study.seed, started: started.toISOString(),
      seconds: (new Date() - started) / 1000, summary: summary(), answers,
    };
    const text = JSON.stringify(result, null, 2);
    element('result').textContent = text;
    element('download').href = 'data:application/json;charset=utf-8,' + encodeURIComponent(text);
    element('study').hidden = true;
    element('end').hidden = false;
  };

  const choose = side => {
    if (answers.length === study.trials.length) return;
    const trial = study.trials[answers.length];
    answers.push({
      pair: trial.pair, sentinel: trial.sentinel, vote: trial.vote, side,
      choice: side === 'left' ? trial.left : trial.right,
      seconds: Math.round(performance.now() - shownAt) / 1000,
    });
    answers.length < study.trials.length ? show() : finish();
  };

  document.addEventListener('keydown', event => {
    if (event.repeat || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === '1') choose('left');
    if (event.key === '2') choose('right');
  });
  for (const side of ['left', 'right']) {
    element(side).addEventListener('click', () => choose(side));
  }
  window.addEventListener('beforeunload', event => {
    if (answers.length > 0 && answers.length < study.trials.length) event.preventDefault();
  });
  element('question').textContent = study.question;
  show();
})();
</script>
</body>
</html>
)html";

/// Pictures, each once, by number.
class Album {
 public:
  std::size_t add(const std::string& uri) {
    const auto [at, fresh] = numbers_.emplace(uri, images_.size());
    if (fresh) images_.push_back(uri);
    return at->second;
  }
  Json take() { return std::move(images_); }

 private:
  std::map<std::string, std::size_t> numbers_;
  Json images_ = Json::array();
};

Json trial_json(const AbTrial& trial, const AbPair& pair, Album& album) {
  struct Side {
    const char* choice;
    std::size_t image;
  };
  const bool b = trial.of_b;
  Side left = {trial.sentinel ? "sound" : "a", album.add(trial.sentinel && b ? pair.b : pair.a)};
  Side right = {trial.sentinel ? "broken" : "b", album.add(!trial.sentinel ? pair.b
                                                           : b             ? pair.broken_b
                                                                           : pair.broken_a)};
  if (trial.swapped) std::swap(left, right);
  Json json = {{"pair", pair.name},         {"sentinel", trial.sentinel},
               {"vote", trial.vote + 1},    {"left", left.choice},
               {"right", right.choice},     {"left_image", left.image},
               {"right_image", right.image}};
  if (!pair.input.empty()) json["input_image"] = album.add(pair.input);
  return json;
}

}  // namespace

std::string html_of(const AbPage& page) {
  Json study = {{"version", PS_VERSION},     {"a", page.name_a},  {"b", page.name_b},
                {"question", page.question}, {"seed", page.seed}, {"trials", Json::array()}};
  Album album;
  for (const AbTrial& trial : page.trials) {
    study["trials"].push_back(trial_json(trial, page.pairs[trial.pair], album));
  }
  study["images"] = album.take();
  std::string html = page_head("Which of two pictures?", kStyle, true) + kBody;
  // A file's name must not end the script: in JSON, < can be said in another way.
  for (const char c : study.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    c == '<' ? html += "\\u003c" : html += c;
  }
  return html + kScript;
}

}  // namespace ps::apps
