% octave_qp(file, count, form): the programs of an exported file through GNU Octave's qp.
%
%   mpmbench_perf --export FOLDER              writes the files
%   octave-cli --eval "addpath bench/perf; octave_qp('FOLDER/per-cv-quiet.txt', 20, 'grown')"
%
% `form` says what Octave is given:
%   full    the moves and one variable a slack, every limit of a row, at once
%   grown   the limits that the answer so far breaks, and their slacks, more of them until it breaks none:
%           the same answer, and what a user who waits for it would do
% qp starts from zero moves and the slacks that they need: a feasible point, if the hard limits allow it. The
% time is the processor time of qp alone, all its calls for one program together. Prints one line: median, quantile 0.99
% and maximum in microseconds, the largest difference to the active-set answer, and how many programs qp did
% not solve.
function octave_qp(file, count, form)
  p = load(file);
  count = min(count, columns(p.gradient));
  microseconds = zeros(count, 1);
  difference = 0;
  not_solved = 0;
  for k = 1:count
    [x, seconds, solved] = solve(p, k, strcmp(form, 'grown'));
    microseconds(k) = 1e6 * seconds;
    if (solved)
      difference = max(difference, norm(x - p.x(:, k), Inf));
    else
      not_solved++;
    end
  end
  t = sort(microseconds);
  printf('%s %s: programs %d, median_us %.0f, p99_us %.0f, max_us %.0f, difference %.1e, not_solved %d\n', ...
         file, form, count, median(t), t(ceil(0.99 * count)), t(end), difference, not_solved);
end

function [x, seconds, solved] = solve(p, k, grown)
  n = rows(p.gradient);
  limits = [p.hard_lower(:, k), p.hard_upper(:, k), p.soft_lower(:, k), p.soft_upper(:, k)];
  limits(p.slack_of_row == 0, 3:4) = repmat([-Inf, Inf], nnz(p.slack_of_row == 0), 1);
  given = isfinite(limits) & !grown;
  x = min(max(zeros(n, 1), p.lower(:, k)), p.upper(:, k));
  seconds = 0;
  do
    [start, H, g, lower, upper, low, A, high, of] = program(p, k, limits, given);
    begin = cputime();
    [z, ~, info] = qp(start, H, g, [], [], lower, upper, low, A, high, optimset('MaxIter', 10000));
    seconds += cputime() - begin;
    solved = info.info == 0;
    x = z(1:n);
    s = zeros(rows(p.slack_quadratic), 1);
    s(of) = z(n + 1:end);
    broken = find_broken(p, limits, x, s) & !given;
    given |= broken;
  until (!solved || !any(broken(:)))
end

% Which limits x and the slacks s break.
function broken = find_broken(p, limits, x, s)
  value = p.rows * x;
  room = zeros(rows(value), 1);
  soft = p.slack_of_row > 0;
  room(soft) = s(p.slack_of_row(soft));
  excess = [limits(:, 1) - value, value - limits(:, 2), ...
            limits(:, 3) - room - value, value - room - limits(:, 4)];
  broken = excess > 1e-9;
end

% The k-th program with the limits `given`, as qp wants it: z = (x, s(of)), low <= A z <= high.
function [start, H, g, lower, upper, low, A, high, of] = program(p, k, limits, given)
  slack = p.slack_of_row;
  of = unique(slack(given(:, 3) | given(:, 4))); % a slack that no limit needs is zero
  number = zeros(max([slack; 1]), 1);
  number(of) = 1:numel(of);
  E = zeros(rows(p.rows), numel(of));
  for i = find(given(:, 3) | given(:, 4))'
    E(i, number(slack(i))) = 1;
  end
  H = blkdiag(p.hessian, 2 * diag(p.slack_quadratic(of)));
  g = [p.gradient(:, k); p.slack_linear(of)];
  lower = [p.lower(:, k); zeros(numel(of), 1)];
  upper = [p.upper(:, k); Inf(numel(of), 1)];
  A = zeros(0, numel(g));
  low = high = zeros(0, 1);
  relaxed = [0, 0, 1, -1]; % the sign of the slack in each kind of limit
  for kind = 1:4
    here = given(:, kind);
    A = [A; p.rows(here, :), relaxed(kind) * E(here, :)];
    if (mod(kind, 2) == 1)
      low = [low; limits(here, kind)];
      high = [high; Inf(nnz(here), 1)];
    else
      low = [low; -Inf(nnz(here), 1)];
      high = [high; limits(here, kind)];
    end
  end
  x = min(max(zeros(columns(p.rows), 1), p.lower(:, k)), p.upper(:, k));
  value = p.rows * x;
  s = zeros(numel(of), 1);
  for i = find(given(:, 3) | given(:, 4))'
    q = number(slack(i));
    s(q) = max([s(q), limits(i, 3) - value(i), value(i) - limits(i, 4)]);
  end
  start = [x; s];
end
