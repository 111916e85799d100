// Builds the page: build.mjs SOURCES SITE. One script and one style sheet, nothing from elsewhere.
import { copyFileSync, mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { build } from 'esbuild';

const [sources, site] = process.argv.slice(2);
mkdirSync(site, { recursive: true });
await build({
  entryPoints: { view: join(sources, 'main.js') },
  outdir: site,
  bundle: true,
  format: 'esm',
  target: 'es2022',
  minify: true,
  legalComments: 'linked',
  nodePaths: [join(process.cwd(), 'node_modules')],
  logLevel: 'warning',
});
copyFileSync(join(sources, 'index.html'), join(site, 'index.html'));
