% A method of assessment in GNU Octave: simulation errors against those of a benchmark, as `sse` of mpmbench.
%
% A template for a method of your own (docs/bring_your_own.md).
%
%   mpmbench compare chapter6.h5 --method-file examples/methods.toml

1;  % a script, which defines functions

function squares = mean_squares (loop)
  % Mean squares of y - y_sim by CV.
  errors = loop.y - loop.y_sim;
  squares = mean (errors .^ 2, 2);
end

function answer = assess (loop, benchmark, threshold)
  % The answer on one loop. It must not depend on loops before it: other loops go to other processes.
  ratio = mean_squares (loop) ./ benchmark;
  answer.flagged = any (ratio > threshold);
  answer.score = max (ratio);
  answer.cv_flagged = (ratio > threshold)';
  answer.cv_score = ratio';
end

threshold = 1.5;
while ischar (line = fgetl (stdin))
  if (isempty (strtrim (line)))  % an empty line follows each message
    continue
  end
  message = jsondecode (line);
  answer = struct ();
  switch (message.ask)
    case "describe"
      if (isfield (message.describe.options, "threshold"))
        threshold = message.describe.options.threshold;
      end
      answer.title = "simulation errors in Octave";
      answer.verdict = "the mean squared simulation error of some CV is above that of the benchmark";
      answer.needs = {"benchmark", "complete_record"};
      answer.answers = {"cv"};
    case "context"
      benchmark = mean_squares (message.context.benchmark);
    case "loop"
      answer = assess (message.loop, benchmark, threshold);
  end
  answer.number = message.number;
  puts ([jsonencode(answer) "\n"]);
  fflush (stdout);
end
