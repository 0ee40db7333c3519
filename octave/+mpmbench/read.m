function data = read (archive, table, index)
% data = mpmbench.read (archive, table, index) reads a table of an archive of mpmbench into a struct with a field for each
% column: numbers as a vector, texts as a cell array. A name such as ivar.y1 becomes ivar_y1.
%
% table: 'experiments' (unless told), 'findings', 'loops', or the name of a method. index: of one experiment; of the
% table 'loops' also one that the archive did not keep. The program mpmbench writes the table: that of the environment
% variable MPMBENCH_PROGRAM, or the one in PATH. For GNU Octave and MATLAB.
  if (nargin < 2)
    table = 'experiments';
  end
  program = getenv ('MPMBENCH_PROGRAM');
  if (isempty (program))
    program = 'mpmbench';
  end
  file = [tempname() '.csv'];
  words = {program, 'export', archive, '--table', table, '-o', file};
  if (nargin > 2)
    words = [words, {'--index', sprintf('%d', index)}];
  end
  quoted = cellfun (@(word) ['''' strrep(word, '''', '''\''''') ''''], words, 'UniformOutput', false);
  [status, said] = system ([strjoin(quoted, ' ') ' 2>&1']);
  if (status ~= 0)
    error ('mpmbench:program', '%s', strtrim (said));
  end
  text = fileread (file);
  delete (file);
  lines = strsplit (strtrim (text), sprintf ('\n'));
  names = fields_of (lines{1});
  cells = cell (numel (lines) - 1, numel (names));
  for row = 1:size (cells, 1)
    cells(row, :) = fields_of (lines{row + 1});
  end
  data = struct ();
  for column = 1:numel (names)
    values = str2double (cells(:, column));
    if (any (isnan (values) & ~ strcmp (cells(:, column), 'NaN')))
      values = cells(:, column);
    end
    data.(regexprep (names{column}, '\W', '_')) = values;
  end
end

function fields = fields_of (line)
% Of a line of CSV: quotes around a field with commas, two in a row for one.
  if (~ any (line == '"'))
    fields = strsplit (line, ',', 'CollapseDelimiters', false);
    return
  end
  tokens = regexp ([line ','], '("(?:[^"]|"")*"|[^,]*),', 'tokens');
  fields = cellfun (@(token) token{1}, tokens, 'UniformOutput', false);
  is_quoted = cellfun (@(field) ~ isempty (field) && field(1) == '"', fields);
  fields(is_quoted) = cellfun (@(field) strrep (field(2:end - 1), '""', '"'), fields(is_quoted), 'UniformOutput', false);
end
