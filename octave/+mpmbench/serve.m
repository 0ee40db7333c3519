function serve (assess, description)
% mpmbench.serve (assess, description) serves a method of assessment to mpmbench: a program of its own in GNU Octave.
%
% assess: answer = assess (loop, context, options). loop has y, u, u_target, d, y_sim, y_set: one row a variable, one
% column a sample; context what a method may know besides, with context.benchmark; options those of the method file.
% The answer has at least the field flagged. description: title, verdict, needs, answers. docs/bring_your_own.md has all
% fields. An error in assess is the reason why its loop has no verdict.
%
% MATLAB cannot read lines from stdin: there, write a file of verdicts (docs/bring_your_own.md).
  options = struct ();
  context = struct ();
  while (true)
    line = fgetl (stdin);
    if (! ischar (line))
      return
    end
    if (isempty (strtrim (line)))  % an empty line follows each message
      continue
    end
    message = jsondecode (line);
    switch (message.ask)
      case 'describe'
        options = message.describe.options;
        answer = description;
      case 'context'
        context = message.context;
        answer = struct ();
      case 'loop'
        try
          answer = assess (message.loop, context, options);
        catch problem
          answer = struct ('error', problem.message);
        end
    end
    answer.number = message.number;
    fprintf (stdout, '%s\n', jsonencode (answer));
    fflush (stdout);
  end
end
